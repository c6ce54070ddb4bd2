// Find on the page: sections without the words are put aside.

import { _ } from "./i18n.js";

const field = document.querySelector("[data-guide-filter]");
const sections = [...document.querySelectorAll("[data-guide-section]")];
const links = new Map([...document.querySelectorAll(".guide-contents a")].map((link) => [link.getAttribute("href").slice(1), link]));
const texts = new Map(sections.map((section) => [section, folded(section.textContent)]));

// Small letters without marks, as the search on the server compares them.
function folded(text) {
  return text.toLowerCase().normalize("NFKD").replace(/[\u0300-\u036f\u00ad]/g, "").replaceAll("ı", "i");
}

function look() {
  const words = folded(field.value).split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const section of sections) {
    const fits = words.every((word) => texts.get(section).includes(word));
    section.hidden = !fits;
    links.get(section.id)?.parentElement.toggleAttribute("hidden", !fits);
    shown += fits;
  }
  const count = document.getElementById("filter-count");
  count.textContent = words.length ? _("{shown} of {count} sections match.", { shown, count: sections.length }) : "";
}

field.addEventListener("input", look);
