// The actions in the frame's slots: one that cannot work says why beside it when it is pressed, until something else is.

import { live } from "./live.js";

function told(form) {
  for (const other of document.querySelectorAll("[data-told]")) if (other !== form) delete other.dataset.told;
  if (form) form.dataset.told = "";
}

const off = "button:disabled, fieldset:disabled";

// The form of an action that is off, around what was pressed or has the focus.
function offAround(target) {
  const form = target.closest?.(".slot .action");
  return form?.querySelector(off) ? form : null;
}

// Who has no pointer comes to the form of a button that is off, and is told there.
function reach() {
  for (const form of document.querySelectorAll(".slot .action")) {
    if (form.querySelector(off)) form.tabIndex = 0;
    else form.removeAttribute("tabindex");
  }
}

// A press on a button that is off reaches its form.
export function start() {
  if (!document.querySelector(".slot")) return;
  for (const kind of ["state", "link"]) live.on(kind, reach);
  addEventListener("focusin", ({ target }) => told(offAround(target)));
  addEventListener("pointerdown", ({ target }) => {
    told(offAround(target));
    if (target.closest?.(".outcome")) return;
    const form = target.closest?.(".slot .action");
    for (const outcome of document.querySelectorAll(".slot .outcome")) if (!form?.contains(outcome)) outcome.replaceChildren();
  });
}
