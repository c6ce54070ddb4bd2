// A question or a refusal that an answer brings is read where it stands: it is scrolled into view.

const KEEP_PX = 12;
const seen = new WeakSet();

// Of a question higher than the screen its end is shown, where its key is.
function bring(question) {
  const least = KEEP_PX + (parseFloat(getComputedStyle(document.documentElement).scrollPaddingTop) || 0);
  const above = least - question.getBoundingClientRect().top;
  if (above > 0) scrollBy({ top: -above, behavior: "instant" });
  const footer = document.querySelector(".footer").getBoundingClientRect();
  const most = (footer.left > 0 ? innerHeight : footer.top) - KEEP_PX; // beside the page on a tablet, below it on a phone
  const below = question.getBoundingClientRect().bottom - most;
  if (below > 0) scrollBy({ top: below, behavior: "instant" });
}

function look() {
  for (const question of document.querySelectorAll("[data-question], form[method=post] .outcome > .outcome-refused")) {
    if (!seen.has(question) && question.checkVisibility()) bring(question);
    seen.add(question);
  }
}

// Who says no is done with the question; without this script the link loads the page again. A note is put aside.
function cancel(event) {
  const key = event.target.closest?.("[data-cancel], [data-close]");
  if (!key) return;
  event.preventDefault();
  key.closest(".question")?.remove();
  key.closest(".note")?.setAttribute("data-closed", "");
}

export function start() {
  document.addEventListener("click", cancel);
  document.addEventListener("htmx:after:swap", look);
  look();
}
