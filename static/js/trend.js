// The last ten minutes of measured and target angles: what was recorded, and from then on what this page hears.

import { chart } from "./chart.js";
import { live } from "./live.js";
import { _ } from "./i18n.js";

const SHOWN_S = 600;
const EVERY_MS = 500;
const holder = document.querySelector("[data-trend]");
const POINTS = 1200;
const COLUMNS = ["measured_azimuth_deg", "target_azimuth_deg", "measured_elevation_deg", "target_elevation_deg"];
let rows = [[], [], [], [], []];
let plot = null;
let takenAt = 0;
let asked = false;

// What was recorded goes before what was heard meanwhile; where it cannot be read, the curves begin now.
async function recall() {
  const end = live.machineNow() ?? live.tracker.at;
  const start = new Date(Date.parse(end) - SHOWN_S * 1000).toISOString();
  const query = new URLSearchParams({ tracker_id: live.trackerId, start, end, points: String(POINTS) });
  const answer = await fetch(`/api/v1/telemetry?${query}`);
  if (!answer.ok) return;
  const { columns } = await answer.json();
  const times = columns.elapsed_s.map((seconds) => Date.parse(start) / 1000 + seconds);
  const heardFrom = rows[0][0] ?? Infinity;
  const count = times.filter((at) => at < heardFrom).length;
  rows = [times, ...COLUMNS.map((name) => columns[name])].map((old, index) => [...old.slice(0, count), ...rows[index]]);
  if (rows[0].length) paint();
}

function take() {
  const one = live.tracker;
  const now = performance.now();
  if (!one || now - takenAt < EVERY_MS) return;
  takenAt = now;
  if (!asked) {
    asked = true;
    recall().catch(() => {});
  }
  const values = [Date.parse(one.at) / 1000, one.measured?.azimuth_deg, one.target?.azimuth_deg, one.measured?.elevation_deg, one.target?.elevation_deg];
  values.forEach((value, index) => rows[index].push(value ?? null));
  while (rows[0].length && rows[0][0] < values[0] - SHOWN_S) rows.forEach((row) => row.shift());
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
  plot.setScale("x", { min: last - SHOWN_S, max: last });
  plot.setData(rows, false);
}

if (holder) {
  addEventListener("theme", () => { plot?.destroy(); plot = null; });
  live.on("state", take);
}
