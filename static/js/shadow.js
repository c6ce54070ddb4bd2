// The shadow test of step 2: where the shadow of a pole points now, and the form for a typed clock.

import { compass, decimals } from "./format.js";
import { _ } from "./i18n.js";
import { live } from "./live.js";

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

document.addEventListener("htmx:config:request", ({ detail: { ctx } }) => {
  if (ctx.request.body?.has?.("at")) ctx.request.body.set("at", new Date().toISOString());
});
document.addEventListener("htmx:after:swap", shadow);
// What was asked about another time is not a question any more.
document.addEventListener("input", () => document.querySelector("#manual-form [data-question]")?.remove());
live.on("state", shadow);
