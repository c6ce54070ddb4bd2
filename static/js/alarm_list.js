// The page of alarms: its list follows the machine, and its keys switch the sound of this browser.

import { live } from "./live.js";
import { clockTime } from "./format.js";
import { mute, mutedUntil, soundIsOn, switchSound } from "./alarms.js";
import { _ } from "./i18n.js";

const soundKey = document.getElementById("sound-key");
const muteKey = document.getElementById("mute-key");
let shownAs = null;
let open = [];

const list = () => document.getElementById("alarm-list");
const signature = (site) => JSON.stringify([site.alarm_counts, site.alarms.map((alarm) => [alarm.alarm_id, alarm.state, alarm.occurrences, alarm.collapsed, alarm.since])]);

// Somebody is typing why an alarm is shelved: the list waits.
const inUse = () => [...list().querySelectorAll("input:not([type=hidden]), select")].some((field) => field === document.activeElement || (field.value !== field.defaultValue && field.tagName === "INPUT"));

function follow({ site }) {
  const now = signature(site);
  if (shownAs === null) shownAs = now;
  if (now === shownAs || inUse()) return;
  shownAs = now;
  open = [...list().querySelectorAll("details[open]")].map((one) => one.id);
  list().dispatchEvent(new Event("alarms-changed"));
}

function reopen() {
  for (const id of open) document.getElementById(id)?.setAttribute("open", "");
}

function paintKeys() {
  const on = soundIsOn();
  soundKey.setAttribute("aria-pressed", String(on));
  soundKey.textContent = on ? _("Sound on") : _("Sound off");
  const muted = mutedUntil() > Date.now();
  muteKey.hidden = !on;
  muteKey.setAttribute("aria-pressed", String(muted));
  muteKey.textContent = muted ? _("Muted until {time}", { time: clockTime(new Date(mutedUntil()).toISOString(), live.zone, false) }) : _("Mute 10 min");
}

soundKey.addEventListener("click", () => {
  switchSound(!soundIsOn());
  paintKeys();
});
muteKey.addEventListener("click", () => {
  mute();
  paintKeys();
});
live.on("state", follow);
live.on("state", paintKeys);
document.addEventListener("htmx:after:swap", reopen);
paintKeys();
