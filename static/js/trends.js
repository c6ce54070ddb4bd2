// Curves of minutes, hours and days: what is stored, and at their end what comes in while one looks.

import { chart } from "./chart.js";
import { live } from "./live.js";
import { separation, unbroken } from "./sphere.js";
import { _ } from "./i18n.js";

const POINTS = 1500;
const said = document.getElementById("trends-state");
const SPAN_S = Number(said.dataset.seconds);
const EVERY_S = Math.max(1, SPAN_S / POINTS);
const cursor = { lock: false, sync: { key: "trends" } };
const ANGLES = [{ label: _("Measured"), colour: "blue", width: 2.5 }, { label: _("Setpoint"), colour: "text", width: 1.5, dash: [7, 5] }, { label: _("Target"), colour: "line", width: 1.5, dash: [2, 4] }];

// What each chart shows: its columns, and how a snapshot tells the same.
const CHARTS = {
  azimuth: { columns: ["measured_azimuth_deg", "setpoint_azimuth_deg", "target_azimuth_deg"], series: ANGLES, turns: true },
  elevation: { columns: ["measured_elevation_deg", "setpoint_elevation_deg", "target_elevation_deg"], series: ANGLES },
  error: { columns: ["off_target_deg"], digits: 3, fromZero: 0.1, series: [{ label: _("Deviation from target"), colour: "text", width: 2 }] },
  wind: { columns: ["wind_mps", "wind_mean_mps"], unit: " m/s", digits: 1, fromZero: 5, series: [{ label: _("Gust"), colour: "text", width: 1.5 }, { label: _("Mean"), colour: "blue", width: 2.5, dash: [8, 4] }] },
  light: { columns: ["irradiance_wm2"], unit: " W/m²", digits: 0, fromZero: 100, series: [{ label: _("Irradiance"), colour: "text", width: 2 }] },
  speed: { columns: ["azimuth_dps", "elevation_dps"], unit: " °/s", series: [{ label: _("Azimuth axis"), colour: "text", width: 2 }, { label: _("Elevation axis"), colour: "blue", width: 2, dash: [8, 4] }] },
  supply: { columns: ["supply_v"], unit: " V", digits: 1, series: [{ label: _("Supply"), colour: "text", width: 2 }] },
};
const NAMES = [...new Set(Object.values(CHARTS).flatMap(({ columns }) => columns))];

const table = { time: [], ...Object.fromEntries(NAMES.map((name) => [name, []])) };
const plots = new Map();
let loaded = false;
let asked = false;

async function load() {
  const end = live.machineNow() ?? live.site.at;
  const start = new Date(Date.parse(end) - SPAN_S * 1000).toISOString();
  const query = new URLSearchParams({ tracker_id: live.trackerId, start, end, points: String(POINTS) });
  document.getElementById("trends-csv").href = `/api/v1/telemetry?${query}&format=csv`;
  const answer = await fetch(`/api/v1/telemetry?${query}`);
  if (!answer.ok) throw new Error((await answer.json()).detail);
  const { columns } = await answer.json();
  const beginS = Date.parse(start) / 1000;
  table.time = columns.elapsed_s.map((seconds) => beginS + seconds);
  columns.off_target_deg = columns.measured_azimuth_deg.map((azimuth, row) => apart(azimuth, columns.measured_elevation_deg[row], columns.target_azimuth_deg[row], columns.target_elevation_deg[row]));
  for (const name of NAMES) table[name] = columns[name];
  loaded = true;
  said.textContent = table.time.length ? "" : _("Nothing was recorded in this span; the curves begin now.");
  draw();
}

const apart = (...angles) => (angles.some((angle) => angle === null || angle === undefined) ? null : separation(...angles));

const known = (name) => table[name].some((value) => value !== null);
const dataOf = ({ columns, turns }) => [table.time, ...columns.map((name) => (turns ? unbroken(table[name]) : table[name]))];

function draw() {
  for (const plot of plots.values()) plot.destroy();
  plots.clear();
  for (const [id, wanted] of Object.entries(CHARTS)) {
    const section = document.getElementById(`trend-${id}`);
    const [holder, nothing] = section.querySelectorAll(".chart, p");
    holder.hidden = !wanted.columns.some(known);
    nothing.hidden = !holder.hidden;
    if (!holder.hidden) plots.set(id, plotOf(holder, wanted));
  }
  refresh();
}

function plotOf(holder, wanted) {
  const range = wanted.fromZero ? (_, __, most) => [0, Math.max(wanted.fromZero, (most ?? 0) * 1.1)] : undefined;
  return chart(holder, { height: 200, zone: live.zone, days: SPAN_S > 86_400, data: dataOf(wanted), cursor, range, unit: wanted.unit, tickUnit: wanted.unit ? "" : undefined, digits: wanted.digits, series: wanted.series });
}

function refresh() {
  const end = Date.parse(live.machineNow() ?? live.site.at) / 1000;
  for (const [id, plot] of plots) {
    plot.setData(dataOf(CHARTS[id]), false);
    plot.setScale("x", { min: end - SPAN_S, max: end });
  }
}

// One more row from the snapshot, as often as the span can show it.
function take() {
  if (!loaded || !live.tracker) return;
  const at = Date.parse(live.tracker.at) / 1000;
  if (at - (table.time[table.time.length - 1] ?? 0) < EVERY_S) return;
  const row = rowOf(live.tracker, live.site.weather);
  const appears = NAMES.some((name) => row[name] !== null && !known(name));
  table.time.push(at);
  for (const name of NAMES) table[name].push(row[name]);
  while (table.time.length && table.time[0] < at - SPAN_S) { table.time.shift(); for (const name of NAMES) table[name].shift(); }
  if (appears) draw(); else refresh();
}

function rowOf(one, weather) {
  const { measured, setpoint, target } = one;
  const row = {
    measured_azimuth_deg: measured?.azimuth_deg, setpoint_azimuth_deg: setpoint?.azimuth_deg, target_azimuth_deg: target?.azimuth_deg,
    measured_elevation_deg: measured?.elevation_deg, setpoint_elevation_deg: setpoint?.elevation_deg, target_elevation_deg: target?.elevation_deg,
    off_target_deg: apart(measured?.azimuth_deg, measured?.elevation_deg, target?.azimuth_deg, target?.elevation_deg),
    wind_mps: weather?.gust_mps, wind_mean_mps: weather?.mean_mps, irradiance_wm2: weather?.readings.irradiance_wm2,
  };
  return Object.fromEntries(NAMES.map((name) => [name, row[name] ?? null]));
}

function begin() {
  if (asked || !live.tracker) return;
  asked = true;
  load().catch((error) => { said.textContent = _("The curves could not be read: {why}", { why: error.message }); });
}

live.on("state", begin);
live.on("state", take);
addEventListener("theme", () => { if (loaded) draw(); });
