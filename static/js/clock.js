// Step 2: this device's clock beside the controller's, and where a shadow points now.

import { clockTime, compass, decimals, signedSeconds } from "./format.js";
import { live } from "./live.js";
import { _ } from "./i18n.js";

const zone = Intl.DateTimeFormat().resolvedOptions().timeZone;
const CLOSE_S = 5;
const ASKED_FROM_S = 60;

function tick() {
  const device = new Date();
  document.getElementById("device-clock").textContent = clockTime(device, live.zone);
  document.getElementById("device-zone").textContent = _("set to {zone}, shown in {shown}", { zone, shown: live.zone });
  const now = live.machineNow();
  const seconds = now === null ? null : (Date.parse(now) - device.getTime()) / 1000;
  document.getElementById("clock-difference").textContent = seconds === null ? "–" : signedSeconds(seconds);
  const apart = seconds !== null && Math.abs(seconds) > ASKED_FROM_S;
  document.getElementById("clock-apart").toggleAttribute("data-off", apart);
  document.getElementById("clock-error")?.toggleAttribute("hidden", apart); // an error of 0 s contradicts it
  document.getElementById("clock-verdict").textContent = seconds === null ? "" : verdict(seconds);
}

function verdict(seconds) {
  if (Math.abs(seconds) < CLOSE_S) return _("the clocks agree");
  return seconds > 0 ? _("the controller is ahead") : _("the controller is behind");
}

function shadow() {
  const sun = live.site?.sun;
  const arrow = document.getElementById("shadow-arrow");
  if (!sun || !arrow) return;
  const up = sun.apparent_elevation_deg > 0;
  const away = (sun.azimuth_deg + 180) % 360;
  arrow.setAttribute("visibility", up ? "visible" : "hidden");
  arrow.setAttribute("transform", `rotate(${away.toFixed(1)})`);
  document.getElementById("shadow-words").textContent = up
    ? shadowWords(away, 1 / Math.tan((sun.apparent_elevation_deg * Math.PI) / 180))
    : _("The sun is {below}° below the horizon now: it must be dark outside.", { below: decimals(-sun.apparent_elevation_deg, 1) });
}

// `times` is how many times as long as its pole a shadow is.
function shadowWords(away, times) {
  const values = { away: away.toFixed(0), point: compass(away), times: decimals(times, 1) };
  return times > 20
    ? _("The shadow of a vertical pole must point to {away}° ({point}) and be more than 20 times as long as the pole. Does the real shadow match?", values)
    : _("The shadow of a vertical pole must point to {away}° ({point}) and be {times} times as long as the pole. Does the real shadow match?", values);
}

document.addEventListener("htmx:config:request", (event) => {
  const { ctx } = event.detail;
  if (ctx.request.body?.has?.("at")) ctx.request.body.set("at", new Date().toISOString());
});
live.on("state", shadow);
setInterval(tick, 250);
tick();
