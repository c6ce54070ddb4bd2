// Hold-to-run: an axis moves only while this page says so, twenty times a second; every way of letting go ends it.

import { facts } from "./facts.js";
import { live } from "./live.js";
import { randomId } from "./orders.js";
import { _ } from "./i18n.js";
import { keepStill, letGo } from "./scroll_anchor.js";

const BEAT_MS = 50;
const SLIDE_PX = 24;
const LEVELS = [40, facts.slow_link_ms, Infinity];
const LEVEL_WORDS = [_("not measured yet"), _("good"), _("fair"), _("too slow")];
const TOLD_WITHIN_MS = 3000;
const KEYS = new Set([" ", "Enter"]);
const said = document.getElementById("jog-words");

let press = null;
let endedAt = -Infinity;

const speed = () => document.querySelector('input[name="speed"]:checked')?.value ?? "slow";

function beat() {
  if (!press) return;
  if (live.link !== "live") {
    end(_("The connection was lost."));
    return;
  }
  const message = { type: "jog", tracker_id: live.trackerId, press_id: press.id, axis: press.axis, direction: press.direction,
    speed: press.speed, sequence: press.sequence, tc: performance.now(), epoch: press.epoch };
  if (live.roundTripMs !== null) message.rtt_ms = live.roundTripMs;
  // A heartbeat that cannot leave now is not sent at all: silence stops the axis, a backlog would move it late.
  if (live.send(message)) press.sequence += 1;
}

function begin(key, pointer) {
  if (press || key.disabled || live.link !== "live" || live.roundTripMs === null) return;
  press = { id: randomId(), key, pointer, axis: key.dataset.jog, direction: Number(key.dataset.direction), speed: speed(), sequence: 0,
    epoch: live.tracker.control.epoch };
  press.box = key.getBoundingClientRect();
  keepStill(key);
  key.dataset.held = "";
  said.textContent = "";
  document.querySelector("#zero-outcome .question")?.remove(); // it named where the axes were
  navigator.vibrate?.(15);
  beat();
  press.timer = setInterval(beat, BEAT_MS);
}

function end(why = "") {
  if (!press) return;
  const { id, key, timer, pointer } = press;
  press = null;
  endedAt = performance.now();
  clearInterval(timer);
  letGo();
  delete key.dataset.held;
  said.textContent = why;
  live.send({ type: "end_jog", tracker_id: live.trackerId, press_id: id });
  beacon(id);
  if (pointer !== undefined && key.hasPointerCapture?.(pointer)) key.releasePointerCapture(pointer);
}

// The same by HTTP, for a socket that has just died; it reaches the machine even while the page is being closed.
function beacon(id) {
  const url = `/trackers/${encodeURIComponent(live.trackerId)}/end-jog`;
  navigator.sendBeacon?.(url, new URLSearchParams({ press_id: id }));
}

function slidOff(event) {
  const { left, right, top, bottom } = press.box;
  return event.clientX < left - SLIDE_PX || event.clientX > right + SLIDE_PX
    || event.clientY < top - SLIDE_PX || event.clientY > bottom + SLIDE_PX;
}

function watch(key) {
  key.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    key.focus({ preventScroll: true });
    if (press) return end(_("Two buttons were touched."));
    if (event.button !== 0 || !event.isPrimary) return undefined;
    key.setPointerCapture(event.pointerId);
    return begin(key, event.pointerId);
  });
  key.addEventListener("pointermove", (event) => {
    if (press?.key === key && event.pointerId === press.pointer && slidOff(event)) end(_("The finger slid off the button."));
  });
  for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
    key.addEventListener(name, (event) => { if (press?.key === key && event.pointerId === press.pointer) end(); });
  }
  key.addEventListener("contextmenu", (event) => { event.preventDefault(); });
  key.addEventListener("keydown", (event) => {
    if (!KEYS.has(event.key)) return;
    event.preventDefault();
    if (!event.repeat) begin(key);
  });
  key.addEventListener("keyup", (event) => { if (KEYS.has(event.key)) { event.preventDefault(); end(); } });
  key.addEventListener("blur", () => { if (press?.key === key) end(); });
  key.addEventListener("click", (event) => event.preventDefault());
}

function judged(message) {
  if (message.press_id !== press?.id) {
    if (message.status === "refused") said.textContent = message.reasons?.map((reason) => reason.message).join(" ") ?? "";
    return undefined;
  }
  if (message.status === "dead") return end(_("The axis stopped: the signal of the held button did not arrive in time. Release the button and press it again."));
  if (message.status !== "ok") end(message.reasons?.map((reason) => `${reason.message} ${reason.hint ?? ""}`).join(" ") || _("The controller stopped the motion."));
  return undefined;
}

// What the controller writes in its journal of a movement that it ended itself; the page's own word may have come first.
function told({ kind, tracker_id: trackerId, message, data }) {
  const mine = press || performance.now() - endedAt < TOLD_WITHIN_MS;
  if (kind !== "jog_ended" || trackerId !== live.trackerId || data?.outcome === "released" || !mine) return;
  end(message);
  said.textContent = message;
}

function paintLink() {
  if (live.link !== "live") return paintNoLink();
  const trip = live.roundTripMs;
  const slow = trip !== null && trip > facts.slow_link_ms;
  const level = trip === null ? 0 : LEVELS.findIndex((most) => trip <= most) + 1;
  document.getElementById("link-quality").dataset.level = level;
  document.getElementById("link-words-jog").textContent = LEVEL_WORDS[level];
  document.getElementById("round-trip").textContent = trip === null ? "" : _("{time} ms", { time: Math.max(1, Math.round(trip)) });
  document.getElementById("link-verdict").textContent = slow ? _("Connection too slow for hold-to-run: use incremental jog.") : "";
  return undefined;
}

function paintNoLink() {
  document.getElementById("link-quality").dataset.level = 0;
  document.getElementById("link-words-jog").textContent = _("no connection");
  for (const id of ["round-trip", "link-verdict"]) document.getElementById(id).textContent = "";
}

// Which way the panel faces, seen from above; nothing is drawn of a drive that does not answer.
function paintFacing({ tracker }) {
  const facing = document.getElementById("jog-facing");
  const { azimuth_deg: azimuth } = tracker?.measured ?? {};
  facing?.setAttribute("visibility", azimuth === undefined ? "hidden" : "visible");
  if (azimuth !== undefined) facing?.setAttribute("transform", `rotate(${azimuth.toFixed(1)})`);
}

// A button that the user's role may not press says which role it needs, and how to get it.
function explain(key) {
  const why = () => {
    said.replaceChildren(document.getElementById("no-jog-words").content.cloneNode(true));
    said.scrollIntoView({ block: "nearest" });
  };
  for (const name of ["pointerdown", "focus", "keydown"]) key.addEventListener(name, why);
}

document.querySelectorAll("[data-jog]:not([data-denied])").forEach(watch);
document.querySelectorAll("[data-jog][data-denied]").forEach(explain);
document.addEventListener("pointerdown", (event) => { if (press && event.pointerId !== press.pointer) end(_("A second finger touched the screen.")); }, true);
addEventListener("pointerdown", ({ target }) => { if (!target.closest?.("[data-jog], #jog-words a")) said.textContent = ""; });
document.addEventListener("visibilitychange", () => { if (document.hidden) end(); });
addEventListener("blur", () => end());
addEventListener("pagehide", () => end());
addEventListener("orientationchange", () => end());
document.addEventListener("htmx:before:swap", (event) => {
  const { target, swap } = event.detail?.ctx ?? {};
  if (press && !String(swap).startsWith("none") && target?.contains?.(press.key)) end();
});
live.on("jog", judged);
live.on("event", told);
live.on("pong", paintLink);
live.on("link", paintLink);
live.on("stopped", () => end(_("Stopped.")));
live.on("link", () => { if (live.link !== "live") end(_("The connection was lost.")); });
live.on("state", () => { if (press?.key.disabled) end(); });
live.on("state", paintFacing);
