// STOP: one touch, by the WebSocket and by POST at the same time, without a question.

import { live } from "./live.js";
import { _ } from "./said.js";

const words = (text) => { document.getElementById("stopped-words").textContent = text; };

export function stop(form) {
  const told = live.trackerId ? { type: "stop", tracker_id: live.trackerId } : { type: "stop_all" };
  live.send(told);
  words("");
  return fetch(form.action, { method: "POST", body: new URLSearchParams({ back: "/" }), headers: { "HX-Request": "true" }, keepalive: true })
    .then((answer) => words(answer.ok ? _("Stopped.") : _("STOP was not confirmed. Use the emergency stop at the cabinet.")))
    .catch(() => words(_("STOP was not confirmed: no connection. Use the emergency stop at the cabinet.")));
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
  live.on("stopped", () => words(_("Stopped.")));
  live.on("problem", (problem) => words(problem.detail));
}
