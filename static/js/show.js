// A show on the machine: the picture, the progress, the planned curves and what is measured along them.

import { facts } from "./facts.js";
import { chart } from "./chart.js";
import { clockTime, duration, shown, words } from "./format.js";
import { live } from "./live.js";
import { PanelScene, turnKeys } from "./panel3d.js";
import { targetOf } from "./scene.js";
import { unbroken } from "./sphere.js";
import { panelOf, place, sunOf } from "./sunpath.js";
import { _ } from "./i18n.js";

const { show: showId, end: showEnd } = document.querySelector("[data-show]").dataset;
const scene = new PanelScene(document.getElementById("show-scene"));
const diagram = document.querySelector(".sunpath");
const PHASES = { going_to_start: _("Going to the start"), ready: _("Ready at the start"), running: _("Running"), paused: _("Paused") };
const MESSAGE_S = 1;
turnKeys(scene);

let table = null;
let plots = null;
let last = null;
let ended = null;

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
    chart(document.getElementById("angles"), { zone: live.zone, range: spread(), data: anglesData(), series: [
      { label: _("Azimuth planned"), colour: "second", dash: [6, 5], width: 1.5 }, { label: _("Azimuth measured"), colour: "text", width: 3 },
      { label: _("Elevation planned"), colour: "blue", dash: [6, 5], width: 1.5 }, { label: _("Elevation measured"), colour: "blue", width: 3 }] }),
    chart(document.getElementById("errors"), { height: 180, zone: live.zone, data: errorData(), range: (_, least, most) => [0, Math.max(0.5, (most ?? 0) * 1.1)],
      series: [{ label: _("Pointing error"), colour: "text", width: 2 }] }),
  ];
}

// From the least to the greatest planned angle, a little more on either side, in whole tens of degrees; the whole circle through north.
function spread() {
  if (table.plannedAzimuth.some((angle) => angle !== null && (angle < 5 || angle > 355))) return [0, 360];
  const planned = [...table.plannedAzimuth, ...table.plannedElevation].filter((angle) => angle !== null);
  return [Math.floor(Math.min(...planned) / 10 - 0.5) * 10, Math.ceil(Math.max(...planned) / 10 + 0.5) * 10];
}

const anglesData = () => [table.time, table.plannedAzimuth, table.azimuth, table.plannedElevation, table.elevation];
const errorData = () => [table.time, table.off];

function note(show) {
  if (!table || !facts.show.on_its_way.includes(show.phase) || !live.tracker.measured) return;
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
    ? _("{elapsed} of {all} · {times} × the sun's speed", values)
    : _("{elapsed} of {all} · {times} × the sun's speed; the sun is down, the panel holds", values);
}

// The sun of a show stays where the show left it: the one outside stands elsewhere, and has nothing to do with it.
function picture(sun, target) {
  scene.show({ sun, panel: panelOf(live.tracker), target });
  place(diagram, "sun", sun);
  place(diagram, "panel", panelOf(live.tracker));
}

// A show that has run to its end is over within a message's time of it; one that was ended earlier stays where it was.
function finish() {
  const { show, sun } = last;
  picture(sun, null);
  document.getElementById("show-phase").textContent = _("Ended");
  if (show.phase === facts.show.running && show.duration_s - show.elapsed_s <= MESSAGE_S) {
    last.show = { ...show, elapsed_s: show.duration_s, sun_time: showEnd };
    progress(last.show);
  } else if (ended) {
    const [at, who] = [clockTime(ended.at, live.zone), shown(ended.actor, "who", live.zone)];
    document.getElementById("show-elapsed").textContent = `${at} · ${who} · ${ended.message}`;
  }
}

// Why a show is over, when, and by whom; the journal's line may come before or after the tracker's state.
function told(event) {
  if (event.kind !== "show_ended" || event.data?.show_id !== showId) return;
  ended = event;
  if (last && !mine()) finish();
}

function progress(show) {
  document.getElementById("show-clock").textContent = clockTime(show.sun_time, live.zone);
  document.getElementById("show-progress").value = show.elapsed_s / show.duration_s;
  document.getElementById("show-elapsed").textContent = progressOf(show);
}

function paint() {
  const show = mine();
  const phase = document.getElementById("show-phase");
  if (!show) {
    if (last) return finish();
    picture(null, null);
    phase.textContent = _("Not on the controller");
    return;
  }
  last = { show, sun: sunOf(live.tracker) };
  picture(last.sun, targetOf(live.tracker));
  phase.textContent = PHASES[show.phase] ?? words(show.phase);
  progress(show);
  note(show);
}

live.on("state", paint);
live.on("event", told);
addEventListener("theme", draw);
load();
