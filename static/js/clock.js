// Step 2: this device's clock beside the controller's, each with the sky that it means.

import { clockTime, dateIn, duration, offsetS } from "./format.js";
import { _ } from "./i18n.js";
import { live } from "./live.js";
import { drawSky, sunWords } from "./sky.js";

const deviceZone = Intl.DateTimeFormat().resolvedOptions().timeZone;
const CLOSE_S = 5;
const ASKED_FROM_S = 60;
const SUN_RENEWED_MS = 20_000;
const KNOWN_ERROR_S = 0.5;
const field = (id) => document.getElementById(id);

let asked = { at: Number.NEGATIVE_INFINITY, place: null, sun: null };

function put(id, text) {
  const element = field(id);
  if (element && element.textContent !== text) element.textContent = text;
}

function utcOffset(ms, zone) {
  const minutes = Math.round(offsetS(ms / 1000, zone) / 60);
  const [hours, rest] = [Math.floor(Math.abs(minutes) / 60), Math.abs(minutes) % 60];
  if (!minutes) return "UTC";
  return `UTC${minutes > 0 ? "+" : "−"}${hours}${rest ? `:${String(rest).padStart(2, "0")}` : ""}`;
}

// The time is shown in the site's zone; that of the device is named where its clocks differ.
function zoneWords(ms) {
  const [shown, own] = [utcOffset(ms, live.zone), utcOffset(ms, deviceZone)];
  return shown === own ? shown : _("{shown}; device set to {zone}", { shown, zone: deviceZone });
}

// Where the sun is at an instant that the device's clock shows: computed by the server, and asked for again as it goes on.
async function sunAt(ms) {
  const place = JSON.stringify(live.site?.location ?? null);
  if (place === asked.place && Math.abs(ms - asked.at) < SUN_RENEWED_MS) return;
  asked = { at: ms, place, sun: place === asked.place ? asked.sun : null };
  const mine = asked;
  const answer = await fetch(`/api/v1/sun?at=${encodeURIComponent(new Date(ms).toISOString())}`).catch(() => null);
  const sun = answer?.ok ? await answer.json() : null;
  if (mine === asked) asked.sun = sun;
}

function showSun(id, sun) {
  drawSky(field(`${id}-sky`), sun);
  put(`${id}-sun`, sunWords(sun));
}

function deviceSun(ms, isApart) {
  if (!live.site?.location) return null;
  if (!isApart) return live.site.sun;
  sunAt(ms);
  return asked.sun;
}

function tick() {
  const device = Date.now();
  put("device-clock", clockTime(device, live.zone));
  put("device-date", dateIn(device, live.zone));
  put("device-zone", zoneWords(device));
  const now = live.machineNow();
  const seconds = now === null ? null : (Date.parse(now) - device) / 1000;
  const isApart = seconds !== null && Math.abs(seconds) > ASKED_FROM_S;
  put("clock-difference", seconds === null ? "–" : Math.abs(seconds) < KNOWN_ERROR_S ? "0 s" : duration(seconds));
  put("clock-verdict", seconds === null ? "" : verdict(seconds));
  field("clock-apart").toggleAttribute("data-off", isApart);
  const isOff = Math.abs(live.site?.clock.off_s ?? 0) >= KNOWN_ERROR_S;
  field("clock-error")?.toggleAttribute("hidden", isApart || !isOff);
  field("clock-warnings").toggleAttribute("hidden", isApart && isSaidByDifference());
  if (now !== null) showSun("device", deviceSun(device, isApart));
}

// That clocks differ is said by the difference itself, unless a clock that NTP keeps is meant.
function isSaidByDifference() {
  const { source, ntp_synchronised: isKept, warnings } = live.site.clock;
  return !(source === "manual" && isKept) && warnings.every(({ code }) => code === "clock_differs");
}

function verdict(seconds) {
  if (Math.abs(seconds) < CLOSE_S) return _("the clocks agree");
  return seconds > 0 ? _("the controller is ahead") : _("the controller is behind");
}

// What was asked about another choice is not a question any more.
field("step-form").addEventListener("change", () => field("clock-asked").replaceChildren());
document.addEventListener("htmx:config:request", ({ detail: { ctx } }) => {
  if (ctx.request.body?.has?.("at")) ctx.request.body.set("at", new Date().toISOString());
});
live.on("state", ({ site }) => showSun("controller", site.sun));
setInterval(tick, 250);
tick();
