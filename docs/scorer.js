// The order of search results: guides come before formulas, and the changelog and other pages about
// the project last. Names of the API come first unless a heading of a guide contains the word, and
// short names before long ones. The other numbers are Sphinx's defaults.
const GUIDES = { recipes: 20, start: 15, gallery: 8, many: 8, explore: 8 };
const LAST = /^(changelog|architecture|contribute|release)$/;
const partsOf = (name) => (name.startsWith("rolling_ellipse.") ? name.split(".").length : 0);
var Scorer = {
  score: ([page, title, anchor, , score]) => score - partsOf(title)
    + (GUIDES[page] ?? (LAST.test(page) ? -10 : 0)) + (anchor && page in GUIDES ? 5 : 0),
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 17, 1: 17, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
