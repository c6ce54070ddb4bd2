// Moves the marks of the sun and of the panel on both sun paths.

import { scaleOf } from "./chart_axis.js";
import { facts } from "./facts.js";
import { live } from "./live.js";


export function place(svg, mark, direction) {
  const element = svg.querySelector(`[data-mark="${mark}"]`);
  if (!element) return;
  const visible = direction && direction.elevation >= -1;
  element.setAttribute("visibility", visible ? "visible" : "hidden");
  if (!visible) return;
  const [x, y] = svg.dataset.x === undefined ? polar(direction) : cartesian(direction, svg.dataset);
  element.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
}

function polar({ azimuth, elevation }) {
  const radius = (facts.sky.radius * (90 - elevation)) / 90;
  const turn = (azimuth * Math.PI) / 180;
  return [radius * Math.sin(turn), -radius * Math.cos(turn)];
}

function cartesian({ azimuth, elevation }, { x, y }) {
  const [across, up] = [scaleOf(x), scaleOf(y)];
  const aside = (((azimuth - across.low) % 360) + 360) % 360;
  return [across.at(across.low + aside), up.at(Math.min(up.high, Math.max(up.low, elevation)))];
}

export const sunOf = (one) => one?.sun && { azimuth: one.sun.azimuth_deg, elevation: one.sun.apparent_elevation_deg };
export const panelOf = (one) => one?.measured && { azimuth: one.measured.azimuth_deg, elevation: one.measured.elevation_deg };

function paint() {
  for (const svg of document.querySelectorAll(".sunpath:not([data-still]), .cartesian")) {
    place(svg, "sun", sunOf(live.tracker ?? live.site));
    place(svg, "panel", panelOf(live.tracker));
  }
}

live.on("state", paint);
