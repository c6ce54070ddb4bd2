// Whether something is under a finger: what it is may not become something else between the press and the click, which
// comes some time after the finger is lifted.

const CLICKS_WITHIN_MS = 500;

// Returns a function that tells whether one of these elements is pressed, or was just now.
export function holding(selector, after = () => {}) {
  const pressed = new Set();
  let until = 0;
  addEventListener("pointerdown", ({ pointerId, target, button }) => { if (!button && target.closest?.(selector)) pressed.add(pointerId); }, true);
  const release = ({ pointerId }) => {
    if (!pressed.delete(pointerId)) return;
    until = performance.now() + CLICKS_WITHIN_MS;
    setTimeout(after, CLICKS_WITHIN_MS + 1);
  };
  for (const kind of ["pointerup", "pointercancel"]) addEventListener(kind, release, true);
  addEventListener("blur", () => {
    pressed.clear();
    after();
  });
  return () => pressed.size > 0 || performance.now() < until;
}
