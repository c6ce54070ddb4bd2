// A button that must be held for 2 s before it counts: what it does is easily done by mistake, and hard to see.

import { facts } from "./facts.js";
import { live } from "./live.js";

const HOLD_MS = 2000;
const KEYS = new Set([" ", "Enter"]);

let held = null;
let spent = false;

function look() {
  if (!held) return;
  const { key, at } = held;
  const share = (performance.now() - at) / HOLD_MS;
  if (key.disabled || !key.isConnected) return end();
  if (share >= 1) {
    spent = held.byPointer;
    end();
    spent = true;
    return key.form.requestSubmit(key);
  }
  key.style.setProperty("--held", `${share * 100}%`);
  held.frame = requestAnimationFrame(look);
  return undefined;
}

function begin(key, byPointer) {
  if (held || key.disabled) return;
  held = { key, at: performance.now(), byPointer };
  held.frame = requestAnimationFrame(look);
}

function end() {
  if (!held) return;
  cancelAnimationFrame(held.frame);
  held.key.style.removeProperty("--held");
  held = null;
}

const keyOf = (event) => event.target.closest?.("[data-hold]");

document.addEventListener("pointerdown", (event) => {
  spent = false;
  const key = keyOf(event);
  if (!key || event.button !== 0 || !event.isPrimary) return end();
  key.setPointerCapture(event.pointerId);
  return begin(key, true);
});
// What the answer puts under a finger that is still there is not tapped by letting go.
document.addEventListener("click", (event) => {
  if (!spent || !event.detail) return;
  spent = false;
  event.preventDefault();
  event.stopImmediatePropagation();
}, { capture: true });
for (const name of ["pointerup", "pointercancel"]) document.addEventListener(name, end);
for (const name of ["blur", "pagehide"]) addEventListener(name, end);
document.addEventListener("contextmenu", (event) => { if (keyOf(event)) event.preventDefault(); });
document.addEventListener("keydown", (event) => {
  if (!keyOf(event) || !KEYS.has(event.key)) return;
  event.preventDefault();
  if (!event.repeat) begin(keyOf(event), false);
});
document.addEventListener("keyup", (event) => {
  if (!keyOf(event) || !KEYS.has(event.key)) return;
  event.preventDefault();
  end();
});
// A touch or a click alone does nothing; the click of a screen reader, which cannot hold, has no detail. Letting go
// of what was held presses nothing that came under the finger meanwhile, as the key that takes it back.
document.addEventListener("click", (event) => {
  if (event.detail === 0 || (!keyOf(event) && !spent)) return;
  event.preventDefault();
  event.stopPropagation();
}, { capture: true });

// Once an axis was moved by hand, setting the home position is what this page is for.
live.on("state", ({ tracker }) => {
  if (!facts.activities.by_hand.includes(tracker?.activity)) return;
  for (const key of document.querySelectorAll("[data-after-jog]")) key.classList.add("key-primary");
});
