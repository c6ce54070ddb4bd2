// One WebSocket a page: state in, jog and stop out. Nothing is kept for later: what cannot be sent now is dropped.

import { facts } from "./facts.js";
import { loadAgain } from "./reload.js";
import { shown } from "./format.js";
import { _ } from "./i18n.js";

const OLD_MS = 1500;
const DEAD_MS = 3000;
const RETRY_MS = 300;
const root = document.documentElement;
const listeners = { state: new Set(), jog: new Set(), stopped: new Set(), event: new Set(), link: new Set(), pong: new Set(), problem: new Set() };

export const live = {
  trackerId: root.dataset.tracker ?? null,
  zone: root.dataset.zone ?? "UTC",
  site: null,
  build: null,
  tracker: null,
  link: "starting",
  roundTripMs: null,
  on(kind, listener) {
    listeners[kind].add(listener);
    if (kind === "state" && live.site) listener(live);
    return () => listeners[kind].delete(listener);
  },
  trackerOf(id) {
    return known.get(id) ?? null;
  },
  // Sends at once or not at all; says which.
  send(message) {
    if (socket?.readyState !== WebSocket.OPEN || socket.bufferedAmount > 0) return false;
    socket.send(JSON.stringify(message));
    return true;
  },
  // The machine's clock now, as its snapshots tell it; null while the link is not live.
  machineNow() {
    if (live.link !== "live") return null;
    return new Date(Date.parse(live.site.at) + (performance.now() - heardAt)).toISOString();
  },
};

let socket = null;
let known = new Map();
let heardAt = 0;
let stateAt = 0;
let openedAt = 0;
let leaving = false;

const ping = () => live.send({ type: "ping", tc: performance.now(), visible: !document.hidden, at: Date.now() });

const tell = (kind, detail) => listeners[kind].forEach((listener) => listener(detail));

function connect() {
  if (leaving) return;
  const asked = new URLSearchParams();
  if (live.trackerId) asked.set("tracker", live.trackerId);
  if (root.lang !== "en") asked.set("language", root.lang);
  if (root.dataset.page) asked.set("page", root.dataset.page);
  if (root.dataset.stopTicket) asked.set("stop_ticket", root.dataset.stopTicket);
  const scheme = location.protocol === "https:" ? "wss" : "ws";
  const mine = new WebSocket(`${scheme}://${location.host}/live?${asked}`);
  socket = mine;
  openedAt = performance.now();
  live.roundTripMs = null;
  mine.onopen = ping;
  mine.onmessage = (message) => mine === socket && hear(JSON.parse(message.data));
  mine.onclose = (closing) => {
    if (mine !== socket) return;
    socket = null;
    if (closing.code === facts.flooded) tell("problem", { detail: _("This page sent more messages than Heliopanel accepts and was disconnected. The page reconnects automatically; STOP works.") });
    judge("closed");
    setTimeout(connect, RETRY_MS);
  };
}

// A state has all trackers; a part of one only those that changed, in the order of no list.
function merged({ part, snapshot }) {
  if (!part) known = new Map();
  for (const one of snapshot.trackers) known.set(one.tracker_id, one);
  return { ...snapshot, trackers: [...known.values()] };
}

const HEARD = {
  state(message) {
    heardAt = stateAt = performance.now();
    live.site = merged(message);
    live.build = message.build;
    live.tracker = live.trackerOf(live.trackerId);
    setLink("live");
    tell("state", live);
  },
  // The session has ended: this page stops, and that is all it can do.
  signed_out() {
    heardAt = performance.now();
    setLink("signed-out");
  },
  machine_lost() {
    heardAt = performance.now();
    setLink("lost");
  },
  jog: (message) => tell("jog", message),
  problem: (message) => tell("problem", message),
  stopped: (message) => tell("stopped", message),
  event: (message) => tell("event", message),
  pong(message) {
    const first = live.roundTripMs === null;
    live.roundTripMs = performance.now() - message.tc;
    if (first) paintActions();
    tell("pong", live);
  },
};

const hear = (message) => HEARD[message.type]?.(message);

function setLink(state) {
  if (live.link === state) return;
  live.link = state;
  root.dataset.link = state;
  tell("link", live);
}

// How long ago the page last heard how things stand, in seconds.
const ageSeconds = () => (stateAt ? (performance.now() - stateAt) / 1000 : null);

function judge(why) {
  const silent = performance.now() - Math.max(stateAt, openedAt);
  if (why === "closed" && live.link === "live") setLink("stale");
  if (live.link !== "lost" && live.link !== "signed-out" && silent > OLD_MS) setLink("stale");
  if (socket && live.link !== "signed-out" && performance.now() - Math.max(heardAt, openedAt) > DEAD_MS) socket.close();
  if (live.link !== "live") tell("link", live);
}

function valueAt(start, path) {
  return path.split(".").reduce((value, name) => value?.[name], start);
}

function scopeOf(element) {
  const holder = element.closest("[data-tracker]");
  return !holder || holder === root ? live.tracker : live.trackerOf(holder.dataset.tracker);
}

function paintValues() {
  for (const element of document.querySelectorAll("[data-live]")) {
    const path = element.dataset.live;
    const value = path.startsWith("site.") ? valueAt(live.site, path.slice(5)) : valueAt(scopeOf(element), path);
    const text = shown(value, element.dataset.form ?? "text", live.zone);
    if (element.textContent !== text) element.textContent = text;
  }
  for (const element of document.querySelectorAll("[data-lamp]")) {
    element.dataset.on = String(Boolean(valueAt(scopeOf(element), element.dataset.lamp)));
  }
  for (const element of document.querySelectorAll("[data-when]")) element.hidden = !holds(element);
}

// `data-when="show.phase=running,paused"`: shown while the value is one of these, with `!=` while it is none of them;
// without `=`, while there is one.
function holds(element) {
  const [place, wanted] = element.dataset.when.split("=");
  const path = place.replace("!", "");
  const value = path.startsWith("site.") ? valueAt(live.site, path.slice(5)) : valueAt(scopeOf(element), path);
  if (wanted === undefined) return Array.isArray(value) ? value.length > 0 : Boolean(value);
  return wanted.split(",").includes(String(value ?? "none")) !== place.endsWith("!");
}

export function fillReasons(list, reasons) {
  const wanted = JSON.stringify(reasons);
  if (list.dataset.filled === wanted) return;
  list.dataset.filled = wanted;
  list.replaceChildren(...reasons.map((reason) => {
    const item = document.createElement("li");
    const words = document.createElement("span");
    const hint = document.createElement("small");
    hint.textContent = reason.hint ?? "";
    words.append(`${reason.message} `, hint);
    item.append(words);
    return item;
  }));
}

const reasonsFor = (element, action) => scopeOf(element)?.actions?.[action] ?? [];

// What is allowed is worked out for who looks: until it comes, the buttons of a tracker's page stay as they are.
const unanswered = () => live.link === "live" && live.tracker !== null && Object.keys(live.tracker.actions).length === 0;

const listed = (path, list) => (path.startsWith("site.") ? valueAt(live.site, path.slice(5)) : scopeOf(list)?.[path]);

function paintActions() {
  for (const key of document.querySelectorAll("[data-action]")) {
    // A key that moves while it is held waits until the connection was measured.
    const unmeasured = "jog" in key.dataset && live.roundTripMs === null;
    if (unanswered() && !unmeasured) continue;
    key.disabled = live.link !== "live" || unmeasured || reasonsFor(key, key.dataset.action).length > 0;
  }
  for (const list of unanswered() ? [] : document.querySelectorAll("[data-reasons]")) fillReasons(list, reasonsFor(list, list.dataset.reasons));
  for (const list of document.querySelectorAll("[data-list]")) fillReasons(list, listed(list.dataset.list, list) ?? []);
}

// Of a drive that does not answer, what it reported last.
function paintStale() {
  for (const note of document.querySelectorAll("[data-stale-note]")) {
    const one = scopeOf(note);
    const lost = Boolean(one && !one.measured);
    note.hidden = !lost;
    if (lost) note.textContent = lastSeen(one);
  }
}

function lastSeen(one) {
  if (!one.last_measured) return _("The drive has not reported its position yet.");
  const { azimuth_deg: azimuth, elevation_deg: elevation } = one.last_measured;
  return _("Last reading {age} ago: azimuth {azimuth}, elevation {elevation}.",
    { age: shown(one.position_age_s, "age"), azimuth: shown(azimuth, "angle2"), elevation: shown(elevation, "angle2") });
}

const LINK_WORDS = { "signed-out": _("signed out"), live: _("live"), stale: _("no connection"), lost: _("no controller"), starting: _("connecting") };

function paintLink() {
  const words = document.getElementById("link-words");
  if (words.textContent !== LINK_WORDS[live.link]) words.textContent = LINK_WORDS[live.link];
  const off = live.link === "stale" || live.link === "lost" || live.link === "signed-out";
  document.getElementById("link-banner").hidden = !off;
  if (off) {
    const age = ageSeconds();
    const told = [OFF_WORDS[live.link]];
    if (age !== null) told.push(_("Values are {age} s old.", { age: Math.round(age) }));
    document.getElementById("link-banner-words").textContent = told.join(" ");
    const advice = document.getElementById("link-banner-advice");
    advice.hidden = live.link === "signed-out";
    if (!advice.hidden) advice.textContent = OFF_ADVICE[live.link];
  }
  if (live.link !== "live") paintActions();
}

const OFF_WORDS = {
  lost: _("The controller service does not answer."),
  stale: _("No connection to the controller."),
  "signed-out": _("Your session has ended: reload the page to sign in. STOP still works."),
};

// Without its service nothing tracks or stows: whether it runs is not known here, so nothing is promised.
const OFF_ADVICE = {
  lost: _("Motion commands are disabled here; tracking and stowing may have stopped."),
  stale: _("Motion commands are disabled here; tracking and stowing do not need this connection."),
};

export function paint() {
  if (!live.site) return;
  paintValues();
  paintActions();
  paintStale();
}

export function start() {
  root.dataset.link = "starting";
  live.on("state", paint);
  live.on("link", paintLink);
  addEventListener("pagehide", () => {
    leaving = true;
    if (socket?.readyState === WebSocket.OPEN) socket.close();
  });
  addEventListener("pageshow", (shownAgain) => { if (shownAgain.persisted) loadAgain(); });
  document.addEventListener("htmx:after:swap", paint);
  setInterval(judge, 250);
  setInterval(ping, 1000);
  connect();
}
