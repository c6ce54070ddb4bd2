// A press is for what was there when the finger came down, and had been there for long enough to be read.

import { _ } from "./i18n.js";

const JUST_CHANGED_MS = 700;

// Refuses presses within an element that has just become about something else, as `what` tells in a text.
export function onlyAsRead(root, what, isFree = () => false) {
  let [now, changedAt, aimedAt, told] = [what(), -JUST_CHANGED_MS, undefined, null];

  function look() {
    const found = what();
    if (found !== now) changedAt = performance.now();
    now = found;
  }

  function aim({ target }) {
    told?.remove();
    if (!root.contains(target)) return;
    look();
    aimedAt = performance.now() - changedAt < JUST_CHANGED_MS ? null : now;
  }

  // What is clicked without a press is clicked by the keyboard or a screen reader.
  function refuse(event) {
    if (!root.contains(event.target)) return;
    if (aimedAt === undefined) aim(event);
    look();
    const isMeant = aimedAt === now;
    aimedAt = undefined;
    if (isMeant || isFree(event.target)) return;
    event.preventDefault();
    event.stopImmediatePropagation();
    told = document.createElement("p");
    told.className = "outcome-refused";
    told.textContent = _("This has just changed. Read it, then press again.");
    (root.querySelector("form:not([hidden]) .outcome") ?? root.querySelector(".outcome")).replaceChildren(told);
  }

  new MutationObserver(look).observe(root, { subtree: true, childList: true, attributes: true, attributeFilter: ["hidden", "data-code", "data-tracker"] });
  for (const kind of ["pointerdown", "keydown"]) addEventListener(kind, aim, true);
  addEventListener("click", refuse, true);
  return look;
}
