// Who has control of this tracker, as seen from this page: the words and keys that fit, and the countdown.

import { live } from "./live.js";

const box = document.getElementById("control");

// The same states as `standing` in app/web/standing.py.
function stateOf(control) {
  const { actor, via, weight } = box.dataset;
  const isMe = (name, how) => name === actor && how === via;
  const wish = control.request;
  if (!control.holder) return "free";
  if (isMe(control.holder, control.via)) {
    if (!wish) return "mine";
    return wish.can_be_refused ? "wished" : "forced";
  }
  if (wish && isMe(wish.by, wish.via)) return wish.takes ? "waiting" : "asked";
  return control.rank > Number(weight) ? "above" : "held";
}

function paint() {
  const control = live.tracker?.control;
  if (!control) return;
  const state = stateOf(control);
  if (box.dataset.state !== state) {
    box.dataset.state = state;
    for (const part of box.querySelectorAll("[data-control]")) part.hidden = !part.dataset.control.split(" ").includes(state);
    const outcome = document.getElementById("control-outcome");
    if (outcome.querySelector(".outcome-ok")) outcome.replaceChildren();
  }
  const left = control.request ? Math.max(0, Math.ceil((Date.parse(control.request.until) - Date.parse(live.site.at)) / 1000)) : null;
  for (const place of box.querySelectorAll("[data-countdown]")) place.textContent = left === null ? "" : `${left} s`;
}

// The epoch that this page's orders are given under; the machine refuses those of an older one.
export const epoch = () => live.tracker?.control?.epoch ?? null;

export function start() {
  if (box) live.on("state", paint);
}
