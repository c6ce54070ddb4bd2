// A show on the machine: the picture, the progress, the planned curves and what is measured along them.

import { chart } from "./chart.js";
import { clockTime, duration, words } from "./format.js";
import { live } from "./live.js";
import { PanelScene, turnKeys } from "./panel3d.js";
import { targetOf } from "./scene.js";
import { unbroken } from "./sphere.js";
import { panelOf, place, sunOf } from "./sunpath.js";
import { _ } from "./said.js";

const showId = document.querySelector("[data-show]").dataset.show;
const scene = new PanelScene(document.getElementById("show-scene"));
const diagram = document.querySelector(".sunpath");
const PHASES = { going_to_start: _("Going to the start"), ready: _("Ready at the start"), running: _("Running"), paused: _("Paused") };
turnKeys(scene);

let table = null;
let plots = null;
let begun = false;

function mine() {
  const show = live.tracker?.show;
  return show?.show_id === showId ? show : null;
}

async function load() {
  const answer = await fetch(`/api/v1/trackers/${encodeURIComponent(live.trackerId)}/shows/${showId}`);
  if (!answer.ok) return;
  const { path } = await answer.json();
  const blank = () => path.sun_time_unix_s.map(() => null);
  table = { time: path.sun_time_unix_s, plannedAzimuth: unbroken(path.panel_azimuth_deg.map((angle) => ((angle % 360) + 360) % 360)), plannedElevation: path.panel_elevation_deg,
    azimuth: blank(), elevation: blank(), off: blank() };
  draw();
}

function draw() {
  if (!table) return;
  plots?.forEach((plot) => plot.destroy());
  plots = [
    chart(document.getElementById("angles"), { zone: live.zone, range: [0, 360], data: anglesData(), series: [
      { label: _("Azimuth planned"), colour: "second", dash: [6, 5], width: 1.5 }, { label: _("Azimuth measured"), colour: "text", width: 3 },
      { label: _("Elevation planned"), colour: "blue", dash: [6, 5], width: 1.5 }, { label: _("Elevation measured"), colour: "blue", width: 3 }] }),
    chart(document.getElementById("errors"), { height: 180, zone: live.zone, data: errorData(), range: (_, least, most) => [0, Math.max(0.5, (most ?? 0) * 1.1)],
      series: [{ label: _("Off the sun"), colour: "text", width: 2 }] }),
  ];
}

const anglesData = () => [table.time, table.plannedAzimuth, table.azimuth, table.plannedElevation, table.elevation];
const errorData = () => [table.time, table.off];

function note(show) {
  if (!table || !["running", "paused"].includes(show.phase) || !live.tracker.measured) return;
  const at = Date.parse(show.sun_time) / 1000;
  const [first, last] = [table.time[0], table.time[table.time.length - 1]];
  const index = Math.round(((at - first) / (last - first)) * (table.time.length - 1));
  fillUpTo(index, { azimuth: live.tracker.measured.azimuth_deg, elevation: live.tracker.measured.elevation_deg, off: live.tracker.off_sun_deg });
  plots[0].setData(anglesData());
  plots[1].setData(errorData());
}

let lastIndex = null;

function fillUpTo(index, values) {
  const from = lastIndex === null || index < lastIndex || index - lastIndex > 40 ? index : lastIndex + 1;
  for (let at = Math.max(0, Math.min(from, index)); at <= index; at += 1) {
    for (const [name, value] of Object.entries(values)) table[name][at] = value ?? null;
  }
  lastIndex = index;
}

function progressOf(show) {
  const values = { elapsed: duration(show.elapsed_s), all: duration(show.duration_s), times: Math.round(show.acceleration) };
  return show.sun_is_up
    ? _("{elapsed} of {all} · {times} × the sun", values)
    : _("{elapsed} of {all} · {times} × the sun; the sun is down, the panel holds", values);
}

function paint() {
  const show = mine();
  const phase = document.getElementById("show-phase");
  scene.show({ sun: sunOf(live.tracker), panel: panelOf(live.tracker), target: targetOf(live.tracker) });
  place(diagram, "sun", sunOf(live.tracker));
  place(diagram, "panel", panelOf(live.tracker));
  if (!show) {
    phase.textContent = begun ? _("Ended") : _("Not on the machine");
    return;
  }
  begun = true;
  phase.textContent = PHASES[show.phase] ?? words(show.phase);
  document.getElementById("show-clock").textContent = clockTime(show.sun_time, live.zone);
  document.getElementById("show-progress").value = show.elapsed_s / show.duration_s;
  document.getElementById("show-elapsed").textContent = progressOf(show);
  note(show);
}

live.on("state", paint);
addEventListener("theme", draw);
load();
