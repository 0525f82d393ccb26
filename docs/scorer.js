// What a word leads to first: guides before formulas, and history last. Names of the API stay first
// where no heading of a guide has the word, short ones before long. Other numbers are Sphinx's own.
const GUIDES = { recipes: 20, start: 15, gallery: 8, many: 8, explore: 8 };
const LAST = /^(changelog|architecture|contribute|release)$/;
const partsOf = (name) => (name.startsWith("rolling_ellipse.") ? name.split(".").length : 0);
var Scorer = {
  score: ([page, title, anchor, , score]) => score - partsOf(title)
    + (GUIDES[page] ?? (LAST.test(page) ? -10 : 0)) + (anchor && page in GUIDES ? 5 : 0),
  objNameMatch: 11, objPartialMatch: 6, objPrio: { 0: 17, 1: 17, 2: -5 }, objPrioDefault: 0,
  title: 15, partialTitle: 7, term: 5, partialTerm: 2,
};
