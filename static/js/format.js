// How values read on a page; app/web/shell/formats.py says the same on the server.

import { facts } from "./facts.js";
import { _, spoken } from "./i18n.js";

const UNKNOWN = "–";

export function decimals(value, digits) {
  const text = value.toFixed(digits);
  return numberOf((Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−"));
}

// A number as the language of the page writes it.
export const numberOf = (value) => String(value).replace(".", spoken.point);

export const angle = (value, digits = 2) => `${decimals(value, digits)}°`;
export const compass = (azimuthDeg) => spoken.compass[Math.round(azimuthDeg / 22.5) % 16];

export function duration(seconds) {
  const total = Math.round(Math.abs(seconds));
  const hours = Math.floor(total / 3600);
  const minutes = Math.floor((total % 3600) / 60);
  const two = (number) => String(number).padStart(2, "0");
  if (hours) return `${hours} h ${two(minutes)} min`;
  if (minutes && total % 60) return `${minutes} min ${two(total % 60)} s`;
  return minutes ? `${minutes} min` : `${total} s`;
}

export function signedSeconds(value) {
  if (Math.abs(value) < 0.5) return "0 s";
  return (value > 0 ? "+" : "−") + duration(value);
}

const formatters = new Map();

function inZone(zone, parts) {
  const name = zone + JSON.stringify(parts);
  if (!formatters.has(name)) {
    formatters.set(name, new Intl.DateTimeFormat("sv-SE", { timeZone: zone, hourCycle: "h23", ...parts }));
  }
  return formatters.get(name);
}

const TIME = { hour: "2-digit", minute: "2-digit", second: "2-digit" };
const DATE = { year: "numeric", month: "2-digit", day: "2-digit" };

export function clockTime(iso, zone, seconds = true) {
  const { second, ...minutes } = TIME;
  return inZone(zone, seconds ? { ...minutes, second } : minutes).format(new Date(iso));
}

const isoDateIn = (iso, zone) => inZone(zone, DATE).format(new Date(iso));

// By how much the clocks of a zone are ahead of UTC.
export function offsetS(seconds, zone) {
  const whole = Math.floor(seconds);
  return Date.parse(`${isoDateIn(whole * 1000, zone)}T${clockTime(whole * 1000, zone)}Z`) / 1000 - whole;
}

function written(pattern, iso, zone) {
  const [year, month, day] = isoDateIn(iso, zone).split("-");
  return pattern.replace("%Y", year).replace("%m", month).replace("%d", day);
}

export const dateIn = (iso, zone) => written(spoken.date, iso, zone);

// Month and day, in the order and with the signs of the language.
export const dayIn = (iso, zone) => written(spoken.date.replace(/^%Y\W|\W?%Y$/, ""), iso, zone);

export function words(value) {
  const text = String(value).replace(/[_-]/g, " ");
  return _(text.charAt(0).toUpperCase() + text.slice(1));
}

// A user at the controller's computer has no name and is told in the language of the page; so was "this computer".
const who = (value) => (value === facts.nameless || value === "this computer" ? _("local user") : String(value));

const FORMS = {
  text: String,
  who,
  words,
  compass,
  horizon: (value) => (value < 0 ? _("below the horizon") : _("above the horizon")),
  duration,
  signed_seconds: signedSeconds,
  freshness: (value) => (value ? _("Stale, not used") : _("Current")),
  factor: (value) => `${Math.round(value).toLocaleString("en").replace(/,/g, " ")} ×`,
  clock: (value, zone) => clockTime(value, zone),
  minute: (value, zone) => clockTime(value, zone, false),
  date: dateIn,
  moment: (value, zone) => `${dateIn(value, zone)} ${clockTime(value, zone)}`,
};

export function shown(value, form, zone) {
  if (value === null || value === undefined) return UNKNOWN;
  if (form in facts.measures) {
    const [digits, unit] = facts.measures[form];
    return decimals(value, digits) + unit;
  }
  return (FORMS[form] ?? FORMS.text)(value, zone);
}
