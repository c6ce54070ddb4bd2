// Find on the page: sections without the words are put aside.

const field = document.querySelector("[data-guide-filter]");
const sections = [...document.querySelectorAll("[data-guide-section]")];
const links = new Map([...document.querySelectorAll(".guide-contents a")].map((link) => [link.getAttribute("href").slice(1), link]));
const texts = new Map(sections.map((section) => [section, section.textContent.toLowerCase()]));

function look() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const section of sections) {
    const fits = words.every((word) => texts.get(section).includes(word));
    section.hidden = !fits;
    links.get(section.id)?.parentElement.toggleAttribute("hidden", !fits);
    shown += fits;
  }
  const count = document.getElementById("filter-count");
  count.textContent = words.length ? `${shown} of ${sections.length} sections have it.` : "";
}

field.addEventListener("input", look);
