// The alarm strip of every page, and the sound of alarms that nobody has acknowledged.

import { facts } from "./facts.js";
import { live } from "./live.js";
import { _ } from "./i18n.js";

const SOUND = "heliopanel-sound";
const MUTED = "heliopanel-muted-until";
const MUTE_MS = 10 * 60 * 1000;
const REPEAT_MS = 3000;
const LOUD_UP_TO = 2;
const TONES_HZ = [880, 660];
const TONE_S = 0.18;

const calls = (alarm) => facts.alarms.calling.includes(alarm.state);
const one = (id) => document.getElementById(id);

// Without the machine nothing is known: what was shown last is no longer the truth.
function paintUnknown() {
  const unknown = live.link !== "live" && live.link !== "starting";
  one("alarm-strip").toggleAttribute("data-unknown", unknown);
  one("alarm-strip").querySelector(".alarm-bell").dataset.number = unknown ? "?" : "0";
  if (!unknown) return;
  setText("alarm-words", _("Alarm status unavailable"));
  for (const item of document.querySelectorAll("[data-count] b")) item.textContent = "?";
}

function setText(id, text) {
  if (one(id).textContent !== text) one(id).textContent = text;
}

function paintCounts(site) {
  setText("alarm-words", site.alarm_counts.standing.some(Boolean) ? _("Alarms") : _("No alarms"));
  for (const item of document.querySelectorAll("[data-count]")) {
    const count = site.alarm_counts.standing[item.dataset.count - 1];
    item.toggleAttribute("data-none", !count);
    const shown = item.querySelector("b");
    if (shown.textContent !== String(count)) shown.textContent = count;
  }
}

let context = null;
let soundedAt = 0;

function stored(name) {
  try { return localStorage.getItem(name); } catch { return null; }
}

function store(name, value) {
  try { localStorage.setItem(name, value); } catch { /* the choice holds for this page only */ }
}

export const soundIsOn = () => stored(SOUND) === "on";

// A device whose clock was ahead is not muted until then.
export function mutedUntil() {
  const until = Number(stored(MUTED) ?? 0);
  return until - Date.now() > MUTE_MS ? 0 : until;
}

export function switchSound(on) {
  store(SOUND, on ? "on" : "off");
  store(MUTED, 0);
  if (on) wake();
}

export const mute = () => store(MUTED, Date.now() + MUTE_MS);

// Browsers let a page make sound only after it was touched once.
export function wake() {
  context ??= new AudioContext();
  if (context.state === "suspended") context.resume();
}

function tone(frequency, from) {
  const source = context.createOscillator();
  const volume = context.createGain();
  source.frequency.value = frequency;
  volume.gain.setValueAtTime(0.0001, from);
  volume.gain.exponentialRampToValueAtTime(0.3, from + 0.02);
  volume.gain.exponentialRampToValueAtTime(0.0001, from + TONE_S);
  source.connect(volume).connect(context.destination);
  source.start(from);
  source.stop(from + TONE_S);
}

function sound() {
  const loud = live.site?.alarms.some((alarm) => calls(alarm) && alarm.priority <= LOUD_UP_TO);
  const due = performance.now() - soundedAt >= REPEAT_MS;
  if (!loud || !due || !soundIsOn() || Date.now() < mutedUntil() || context?.state !== "running") return;
  soundedAt = performance.now();
  document.documentElement.dataset.sounded = String(Number(document.documentElement.dataset.sounded ?? 0) + 1);
  TONES_HZ.forEach((frequency, place) => tone(frequency, context.currentTime + place * (TONE_S + 0.04)));
}

export function start() {
  if (!one("alarm-strip")) return;
  live.on("state", ({ site }) => {
    paintCounts(site);
    sound();
  });
  live.on("link", paintUnknown);
  const touched = () => soundIsOn() && wake();
  for (const kind of ["pointerdown", "keydown"]) document.addEventListener(kind, touched);
}
