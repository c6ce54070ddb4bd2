// Moves the marks of the sun and of the panel on the polar sun path.

import { live } from "./live.js";

const HORIZON = 100;

export function place(svg, mark, direction) {
  const element = svg.querySelector(`[data-mark="${mark}"]`);
  const visible = direction && direction.elevation >= -1;
  element.setAttribute("visibility", visible ? "visible" : "hidden");
  if (!visible) return;
  const radius = (HORIZON * (90 - direction.elevation)) / 90;
  const turn = (direction.azimuth * Math.PI) / 180;
  element.setAttribute("transform", `translate(${(radius * Math.sin(turn)).toFixed(2)} ${(-radius * Math.cos(turn)).toFixed(2)})`);
}

export const sunOf = (one) => one?.sun && { azimuth: one.sun.azimuth_deg, elevation: one.sun.apparent_elevation_deg };
export const panelOf = (one) => one?.measured && { azimuth: one.measured.azimuth_deg, elevation: one.measured.elevation_deg };

function paint() {
  for (const svg of document.querySelectorAll(".sunpath:not([data-still])")) {
    place(svg, "sun", sunOf(live.tracker));
    place(svg, "panel", panelOf(live.tracker));
  }
}

live.on("state", paint);
