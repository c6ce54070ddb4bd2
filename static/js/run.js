// Step 5: where the axes would go, and how long that takes by their speeds and ramps.

import { duration, shown } from "./format.js";
import { live } from "./live.js";

const AXES = ["azimuth", "elevation"];
const numbers = (text) => text?.split(" ").map(Number) ?? null;

// Seconds from rest to rest: with a stretch at full speed, or speeding up and slowing down alone.
function lasts(away, speed, acceleration) {
  const ramps = speed ** 2 / acceleration;
  return away > ramps ? away / speed + speed / acceleration : 2 * Math.sqrt(away / acceleration);
}

function paint() {
  const { aim: aimed, speeds, accelerations } = document.getElementById("run-aim").dataset;
  const aim = numbers(aimed);
  for (const to of document.querySelectorAll("[data-to]")) to.textContent = aim ? shown(aim[AXES.indexOf(to.dataset.to)], "angle2") : "–";
  const night = document.getElementById("run-night");
  night.hidden = Boolean(aim) || !live.tracker?.mode || live.tracker?.sun_is_up !== false;
  const stands = AXES.map((axis) => live.tracker?.[axis]?.position_deg);
  const isKnown = aim && Number.isFinite(stands[0]);
  const each = isKnown ? AXES.map((_, at) => (Number.isFinite(stands[at])
    ? lasts(Math.abs(aim[at] - stands[at]), numbers(speeds)[at], numbers(accelerations)[at]) : 0)) : [];
  document.getElementById("run-lasts").textContent = isKnown ? duration(Math.ceil(Math.max(...each))) : "–";
}

live.on("state", paint);
document.addEventListener("htmx:after:swap", paint);
