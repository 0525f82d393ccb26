// Gives a frame the height that its page reports.
addEventListener("message", ({ data, source }) => {
  for (const frame of document.querySelectorAll("iframe"))
    if (frame.contentWindow === source && data?.rollingEllipse)
      frame.style.height = `${data.rollingEllipse.height}px`;
});

// Makes overflowing boxes scrollable with the keyboard, and names the sidebars.
addEventListener("DOMContentLoaded", () => {
  for (const box of document.querySelectorAll("pre, .table-wrapper, mjx-container[display=true]"))
    if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
  // A click on a picture opens its file
  for (const picture of document.querySelectorAll("article img"))
    if (!picture.closest("a")) {
      const link = Object.assign(document.createElement("a"), { href: picture.src });
      picture.replaceWith(link);
      link.append(picture);
    }
  // Sphinx breaks long signatures into lists without terms; its citation lists have no items
  for (const part of document.querySelectorAll(".sig dl, .sig dd")) part.role = "presentation";
  for (const entry of document.querySelectorAll(".citation-list > .citation")) entry.role = "listitem";
  const names = { "sidebar-drawer": "Site", "toc-drawer": "On this page" };
  for (const side of document.querySelectorAll("aside"))
    for (const name of side.classList) if (names[name]) side.setAttribute("aria-label", names[name]);
});
