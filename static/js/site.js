// The weather card is read again when other quantities are known or implausible than those that it shows, or made up.

import { live } from "./live.js";

const LEAST_MS = 2000;
const READINGS = "site.weather.readings.";
const IMPLAUSIBLE = "!";
const NOTHING = { readings: {}, quantities: {}, simulated: false, before_restart: false };
let askedAt = -Infinity;

const card = () => document.getElementById("weather");

function shown() {
  const names = [...card().querySelectorAll(`[data-live^="${READINGS}"]`)].map((element) =>
    element.dataset.live.slice(READINGS.length) + (element.closest("[data-implausible]") ? IMPLAUSIBLE : ""));
  return keyOf(names, card().hasAttribute("data-simulated"), card().hasAttribute("data-before-restart"));
}

function known({ readings, quantities, simulated, before_restart: old } = NOTHING) {
  const implausible = (name) => quantities[name]?.quality === "impossible";
  const names = Object.keys(readings).filter((name) => readings[name] !== null || implausible(name));
  return keyOf(names.map((name) => name + (implausible(name) ? IMPLAUSIBLE : "")), simulated, old);
}

const keyOf = (names, simulated, old) => [...names.sort(), simulated, old].join(" ");

async function follow() {
  if (!card() || performance.now() - askedAt < LEAST_MS || shown() === known(live.site.weather ?? undefined)) return;
  askedAt = performance.now();
  const answer = await fetch("/site");
  if (!answer.ok) return;
  const fresh = new DOMParser().parseFromString(await answer.text(), "text/html").getElementById("weather");
  if (fresh) card()?.replaceWith(fresh);
}

live.on("state", () => { follow().catch(() => {}); });
