// Keeps the step bar and the key forward true: asks for them again when something that decides a step has changed.

import { live } from "./live.js";

let known = null;

function decisive() {
  const { site, tracker } = live;
  if (!tracker) return null;
  return JSON.stringify([tracker.activity, tracker.homed, tracker.mode, tracker.orientation, tracker.tracking_on, tracker.in_position,
    tracker.fault?.code, Boolean(tracker.measured), site.clock.trusted, site.clock.source, site.location, site.time_zone]);
}

function ask() {
  const step = document.documentElement.dataset.step;
  const url = `/trackers/${encodeURIComponent(live.trackerId)}/commissioning/progress/${step}?here=${encodeURIComponent(location.pathname)}`;
  window.htmx.ajax("GET", url, { swap: "none" });
}

function look() {
  const now = decisive();
  if (now === null || now === known) return;
  const first = known === null;
  known = now;
  if (!first) ask();
}

export function start() {
  if (!document.getElementById("steps")) return;
  live.on("state", look);
  document.addEventListener("htmx:after:request", (event) => {
    const { request, response } = event.detail?.ctx ?? {};
    if (request?.method?.toUpperCase() === "POST" && response?.status < 400) ask(); // what was refused is read where it stands
  });
}
