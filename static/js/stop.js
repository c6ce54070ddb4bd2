// STOP: one touch, by the WebSocket and by POST at the same time, without a question. What was not confirmed is said at
// the button, in red, until it is closed or a later STOP is confirmed.

import { live } from "./live.js";
import { _ } from "./i18n.js";

const CONFIRM_MS = 1500;
const NOT_SENT = _("STOP was not sent: no connection. Use the emergency stop at the cabinet.");
const NOT_CONFIRMED = _("STOP was not confirmed. Use the emergency stop at the cabinet.");
const hasController = () => live.link === "live" || live.link === "signed-out" || live.link === "starting";

let pending = null;

function tell(text, failed) {
  document.getElementById("stopped-words").textContent = text;
  document.getElementById("stop-failed").textContent = failed ? text : "";
  document.getElementById("stop-answer").hidden = !failed;
}

function confirmed() {
  clearTimeout(pending?.timer);
  pending = null;
  tell(_("Stopped."), false);
}

function failed(press, text) {
  if (press !== pending) return;
  clearTimeout(press.timer);
  if (!press.closed) tell(text, true);
}

export function stop(form) {
  clearTimeout(pending?.timer);
  const told = live.trackerId ? { type: "stop", tracker_id: live.trackerId } : { type: "stop_all" };
  const press = { sent: live.send(told) };
  pending = press;
  if (hasController()) {
    tell("", false);
    press.timer = setTimeout(() => failed(press, NOT_CONFIRMED), CONFIRM_MS);
  } else {
    tell(NOT_SENT, true);
  }
  return fetch(form.action, { method: "POST", body: new URLSearchParams({ back: "/" }), headers: { "HX-Request": "true" }, keepalive: true })
    .then((answer) => (answer.ok ? press === pending && confirmed() : failed(press, hasController() ? NOT_CONFIRMED : NOT_SENT)))
    .catch(() => failed(press, press.sent && hasController() ? NOT_CONFIRMED : NOT_SENT));
}

export function start() {
  const form = document.getElementById("stop-form");
  const key = document.getElementById("stop-key");
  if (!form) return;
  let sentAt = -Infinity;
  const press = (event) => {
    event.preventDefault();
    if (performance.now() - sentAt < 250) return;
    sentAt = performance.now();
    key.dataset.pressed = "";
    setTimeout(() => delete key.dataset.pressed, 400);
    stop(form);
  };
  key.addEventListener("pointerdown", press);
  form.addEventListener("submit", press);
  addEventListener("keydown", (event) => { if (event.key === "Escape" && !event.repeat) press(event); });
  document.getElementById("stop-answer-close").addEventListener("click", () => {
    if (pending) pending.closed = true;
    tell("", false);
  });
  live.on("stopped", confirmed);
  live.on("problem", (problem) => { if (pending) failed(pending, `${problem.detail} ${NOT_CONFIRMED}`); });
}
