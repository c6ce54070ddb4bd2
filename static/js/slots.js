// The actions in the frame's slots, and the keys to hold: what cannot work says why when pressed, until something else is.

import { onlyAsRead } from "./as_read.js";
import { live } from "./live.js";

const UNSEEN_MS = 700;

function told(form) {
  for (const other of document.querySelectorAll("[data-told]")) if (other !== form) delete other.dataset.told;
  if (form) form.dataset.told = "";
}

const off = "button:disabled, fieldset:disabled";

// The form of an action that is off around what was pressed or has the focus; or the panel of keys that are.
function offAround(target, kinds) {
  const form = target.closest?.(kinds);
  return form?.querySelector(off) ? form : null;
}

// Who has no pointer comes to the form of a button that is off, and is told there.
function reach() {
  for (const form of document.querySelectorAll(".slot .action")) {
    if (form.querySelector(off)) form.tabIndex = 0;
    else form.removeAttribute("tabindex");
  }
}

// Which actions a slot has now; Start tracking and End tracking share one.
function actionsOf(slot) {
  const forms = [...slot.querySelectorAll("form.action:not([hidden])")];
  return forms.map((form) => `${form.getAttribute("action")} ${form.elements.position?.value ?? ""}`).join();
}

// Who goes on by a double tap has not seen the page that the second one meets: it saves nothing there.
function waitToSave() {
  const save = document.querySelector(".slots-steps #forward button[form]:not(:disabled)");
  if (!save) return;
  Object.assign(save, { disabled: true }).dataset.unseen = "";
  setTimeout(() => {
    save.disabled = false;
    delete save.dataset.unseen;
  }, UNSEEN_MS);
}

// A press on a button that is off reaches its form.
export function start() {
  waitToSave();
  if (!document.querySelector(".slot, .jog")) return;
  for (const slot of document.querySelectorAll(".slot:has(form.action + form.action)")) onlyAsRead(slot, () => actionsOf(slot));
  for (const kind of ["state", "link"]) live.on(kind, reach);
  addEventListener("focusin", ({ target }) => told(offAround(target, ".slot .action")));
  addEventListener("pointerdown", ({ target }) => {
    told(offAround(target, ".slot .action, .jog, .axis-steps"));
    if (target.closest?.(".outcome")) return;
    const form = target.closest?.(".slot .action");
    for (const outcome of document.querySelectorAll(".slot .outcome")) if (!form?.contains(outcome)) outcome.replaceChildren();
  });
}
