// The last ten minutes of measured and target angles, kept by this page.

import { chart } from "./chart.js";
import { live } from "./live.js";
import { _ } from "./said.js";

const SPAN_S = 600;
const EVERY_MS = 500;
const holder = document.querySelector("[data-trend]");
const rows = [[], [], [], [], []];
let plot = null;
let takenAt = 0;

function take() {
  const one = live.tracker;
  const now = performance.now();
  if (!one || now - takenAt < EVERY_MS) return;
  takenAt = now;
  const values = [Date.parse(one.at) / 1000, one.measured?.azimuth_deg, one.target?.azimuth_deg, one.measured?.elevation_deg, one.target?.elevation_deg];
  values.forEach((value, index) => rows[index].push(value ?? null));
  while (rows[0].length && rows[0][0] < values[0] - SPAN_S) rows.forEach((row) => row.shift());
  paint();
}

function paint() {
  plot ??= chart(holder, {
    series: [
      { label: _("Azimuth"), colour: "text", width: 2.5 },
      { label: _("Azimuth target"), colour: "second", dash: [6, 5] },
      { label: _("Elevation"), colour: "blue", width: 2.5 },
      { label: _("Elevation target"), colour: "blue", dash: [6, 5], width: 1.5 },
    ],
    zone: live.zone,
  });
  const last = rows[0][rows[0].length - 1];
  plot.setScale("x", { min: last - SPAN_S, max: last });
  plot.setData(rows, false);
}

if (holder) {
  addEventListener("theme", () => { plot?.destroy(); plot = null; });
  live.on("state", take);
}
