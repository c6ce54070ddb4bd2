// Moves the marks of the sun and of the panel on both sun paths.

import { live } from "./live.js";

const HORIZON = 100;
const CARTESIAN = { left: 56, bottom: 286, perDegree: 2, rise: 3 };

export function place(svg, mark, direction) {
  const element = svg.querySelector(`[data-mark="${mark}"]`);
  if (!element) return;
  const visible = direction && direction.elevation >= -1;
  element.setAttribute("visibility", visible ? "visible" : "hidden");
  if (!visible) return;
  const [x, y] = svg.dataset.centre === undefined ? polar(direction) : cartesian(direction, Number(svg.dataset.centre));
  element.setAttribute("transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})`);
}

function polar({ azimuth, elevation }) {
  const radius = (HORIZON * (90 - elevation)) / 90;
  const turn = (azimuth * Math.PI) / 180;
  return [radius * Math.sin(turn), -radius * Math.cos(turn)];
}

function cartesian({ azimuth, elevation }, centre) {
  const aside = (((azimuth - centre + 180) % 360) + 360) % 360;
  const { left, bottom, perDegree, rise } = CARTESIAN;
  return [left + aside * perDegree, bottom - Math.min(90, Math.max(0, elevation)) * rise];
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
