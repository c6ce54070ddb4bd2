// Puts the cross of the picture of the forbidden regions where the axes stand.

import { scaleOf } from "./chart_axis.js";
import { live } from "./live.js";

function place() {
  const picture = document.getElementById("regions-picture");
  const mark = picture?.querySelector("[data-here]");
  if (!mark) return;
  const azimuth = live.tracker?.azimuth?.position_deg ?? null;
  const elevation = live.tracker?.elevation?.position_deg ?? null;
  const known = azimuth !== null && elevation !== null;
  mark.setAttribute("visibility", known ? "visible" : "hidden");
  if (!known) return;
  const [x, y] = [scaleOf(picture.dataset.x).at(azimuth), scaleOf(picture.dataset.y).at(elevation)];
  mark.setAttribute("transform", `translate(${x.toFixed(1)} ${y.toFixed(1)})`);
}

live.on("state", place);
document.addEventListener("htmx:after:swap", place);
