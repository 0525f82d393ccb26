// A frame of a page with a motion is as high as the page says.
addEventListener("message", ({ data, source }) => {
  for (const frame of document.querySelectorAll("iframe"))
    if (frame.contentWindow === source && data?.rollingEllipse)
      frame.style.height = `${data.rollingEllipse.height}px`;
});

// What scrolls can be scrolled by keys, and the two sidebars have names of their own.
addEventListener("DOMContentLoaded", () => {
  for (const box of document.querySelectorAll("pre, .table-wrapper, mjx-container[display=true]"))
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
  // Sphinx breaks long signatures into a list without terms, and calls entries of a list by no item
  for (const part of document.querySelectorAll(".sig dl, .sig dd")) part.role = "presentation";
  for (const entry of document.querySelectorAll(".citation-list > .citation")) entry.role = "listitem";
  const names = { "sidebar-drawer": "Site", "toc-drawer": "On this page" };
  for (const side of document.querySelectorAll("aside"))
    for (const name of side.classList) if (names[name]) side.setAttribute("aria-label", names[name]);
});
