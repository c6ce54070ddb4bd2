// Keeps a held key under the finger: whatever grows or goes above it, the page is scrolled before that is painted.

const AFTER_MS = 3000;
const LEAST_PX = 0.5;
const content = document.getElementById("content");

let held = null;
let roomPx = 0;

const movedPx = () => held.key.getBoundingClientRect().top - held.top;

// What cannot be scrolled, as at the head of a page, becomes room above the content; it is given back first.
function setRoom(px) {
  roomPx = Math.max(0, px);
  content.style.marginTop = roomPx ? `${roomPx}px` : "";
}

function straighten() {
  if (Math.abs(movedPx()) < LEAST_PX) return;
  if (movedPx() > 0 && roomPx) setRoom(roomPx - movedPx());
  scrollBy({ top: movedPx(), behavior: "instant" });
  if (movedPx() <= -LEAST_PX) setRoom(roomPx - movedPx());
}

function look() {
  if (!held) return;
  straighten();
  if (held.until && performance.now() > held.until) held = null;
  else held.frame = requestAnimationFrame(look);
}

export function keepStill(key) {
  if (held) cancelAnimationFrame(held.frame);
  held = { key, top: key.getBoundingClientRect().top, until: 0 };
  held.frame = requestAnimationFrame(look);
}

// What a movement changed on the page changes back after it.
export function letGo() {
  if (held) held.until = performance.now() + AFTER_MS;
}

// Whoever scrolls, presses or turns the tablet afterwards wants the page elsewhere.
for (const kind of ["wheel", "pointerdown", "keydown", "resize"]) {
  addEventListener(kind, () => { if (held?.until) held = null; }, { capture: true, passive: true });
}
