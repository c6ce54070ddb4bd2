// Plays a recording: picture, sun path, curves and values at one instant, which the scrubber or the clock moves.

import { chart } from "./chart.js";
import { angle, clockTime, dateIn, words } from "./format.js";
import { PanelScene, turnKeys } from "./panel3d.js";
import { separation, unbroken } from "./sphere.js";
import { place } from "./sunpath.js";
import { _ } from "./i18n.js";

// As many frames as curves of this screen's width can show, whose extremes are kept.
const POINTS = Math.max(1500, Math.min(6000, Math.round(innerWidth * devicePixelRatio * 2)));
const TELL_EVERY_MS = 60;
const ANGLES = ["sun", "target", "setpoint", "measured"];
const head = document.getElementById("player").dataset;
const scene = new PanelScene(document.getElementById("player-scene"), { settle: false });
const diagram = document.querySelector(".sunpath");
const key = document.getElementById("player-play");
const scrubber = document.getElementById("player-scrubber");
const said = document.getElementById("player-state");
turnKeys(scene);

let tape = null;
let other = null;
let plots = [];
let drawn = 0;
let at = 0;
let playing = false;
let tickAt = 0;
let toldAt = 0;

async function read(id, begin, zone) {
  const answer = await fetch(`/api/v1/recordings/${encodeURIComponent(id)}/samples?points=${POINTS}`);
  if (!answer.ok) throw new Error((await answer.json()).detail);
  const { columns, activities } = await answer.json();
  const beginS = Date.parse(begin) / 1000;
  const error = columns.measured_azimuth_deg.map((azimuth, row) => (azimuth === null || columns.target_azimuth_deg[row] === null ? null
    : separation(azimuth, columns.measured_elevation_deg[row], columns.target_azimuth_deg[row], columns.target_elevation_deg[row])));
  return { columns, activities, error, time: columns.sun_time_s.map((seconds) => beginS + seconds), zone };
}

// Puts another day's hours over this day's.
function shifted(tape2) {
  const shift = localMidnight(tape) - localMidnight(tape2);
  return tape2.time.map((seconds) => seconds + shift);
}

function localMidnight({ time, zone }) {
  const [hours, minutes, seconds] = clockTime(time[0] * 1000, zone).split(":").map(Number);
  return Math.round(time[0] - (hours * 3600 + minutes * 60 + seconds));
}

function curves(mine) {
  const { columns } = mine;
  return [columns.target_azimuth_deg, columns.setpoint_azimuth_deg, columns.measured_azimuth_deg].map(unbroken)
    .concat([columns.target_elevation_deg, columns.setpoint_elevation_deg, columns.measured_elevation_deg]);
}

const SERIES = [
  { label: _("Azimuth planned"), colour: "second", dash: [7, 5], width: 1.5 },
  { label: _("setpoint"), colour: "line", dash: [2, 4], width: 1.5 },
  { label: _("measured"), colour: "text", width: 2.5 },
  { label: _("Elevation planned"), colour: "blue", dash: [7, 5], width: 1.5 },
  { label: _("setpoint"), colour: "line", dash: [2, 4], width: 1.5 },
  { label: _("measured"), colour: "blue", width: 2.5 },
];

let printing = null;
const toBePrinted = new Promise((done) => { printing = done; });
addEventListener("beforeprint", printing);

// Resolves once something is on the screen, or nearly so, or is to be printed.
const near = (holder) => Promise.race([toBePrinted, onScreen(holder)]);

const onScreen = (holder) => new Promise((done) => {
  const watcher = new IntersectionObserver((seen) => {
    if (!seen.at(-1).isIntersecting) return;
    watcher.disconnect();
    done();
  }, { rootMargin: "25%" });
  watcher.observe(holder);
});

// One chart at a time and where somebody looks: what is pressed meanwhile does not wait for both.
async function draw() {
  const mine = drawn += 1;
  plots.forEach((plot) => plot.destroy());
  plots = [];
  show();
  const cursor = { lock: false, sync: { key: "player" } };
  const withOther = other ? [{ label: _("Other azimuth"), colour: "p1", width: 1.5 }, { label: _("Other elevation"), colour: "p1", width: 1.5, dash: [4, 3] }] : [];
  const base = [tape.time, ...curves(tape)];
  const angles = other ? window.uPlot.join([base, [shifted(other), unbroken(other.columns.measured_azimuth_deg), other.columns.measured_elevation_deg]]) : base;
  const errors = other ? window.uPlot.join([[tape.time, tape.error], [shifted(other), other.error]]) : [tape.time, tape.error];
  const wanted = {
    angles: { zone: head.playerZone, data: angles, range: [0, 360], cursor, series: [...SERIES, ...withOther] },
    errors: { height: 180, zone: head.playerZone, data: errors, cursor, digits: 3,
      range: (_, least, most) => [0, Math.max(0.1, (most ?? 0) * 1.1)], series: [{ label: _("Tracking error"), colour: "text" }, ...(other ? [{ label: _("Other"), colour: "p1", width: 1.5 }] : [])] },
  };
  for (const [name, options] of Object.entries(wanted)) {
    const holder = document.getElementById(name);
    await near(holder);
    if (mine !== drawn) return;
    const plot = chart(holder, options);
    plots.push(plot);
    plot.over.addEventListener("click", () => { if (plot.cursor.left >= 0) seek(elapsedAt(plot.posToVal(plot.cursor.left, "x"))); });
    requestAnimationFrame(show);  // A new chart has its scales only after its first frame.
  }
}

function elapsedAt(unixSeconds) {
  return tape.columns.elapsed_s[rowOf(tape.time, unixSeconds)];
}

function rowOf(column, value) {
  let [low, high] = [0, column.length - 1];
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (column[middle] <= value) low = middle; else high = middle - 1;
  }
  return low;
}

function direction(name, row) {
  const azimuth = tape.columns[`${name}_azimuth_deg`][row];
  return azimuth === null ? null : { azimuth, elevation: tape.columns[`${name}_elevation_deg`][row] };
}

// A direction between this row and the next one, so that a slow recording moves as smoothly as a fast one.
function between(name, row) {
  const [from, to] = [direction(name, row), row + 1 < tape.time.length ? direction(name, row + 1) : null];
  if (!from || !to) return from;
  const times = tape.columns.elapsed_s;
  const share = Math.min(1, Math.max(0, (at - times[row]) / (times[row + 1] - times[row])));
  const turn = ((to.azimuth - from.azimuth + 540) % 360) - 180;
  return { azimuth: from.azimuth + turn * share, elevation: from.elevation + (to.elevation - from.elevation) * share };
}

function show() {
  const row = rowOf(tape.columns.elapsed_s, at);
  const [sun, panel] = [direction("sun", row), direction("measured", row)];
  scene.show({ sun: between("sun", row), panel: between("measured", row), target: between("target", row) });
  // The picture moves with every frame of the screen; numbers and cursors that nobody can read so fast do not.
  const now = performance.now();
  if (playing && now - toldAt < TELL_EVERY_MS) return;
  toldAt = now;
  place(diagram, "sun", sun);
  place(diagram, "panel", panel);
  tell(row);
}

function tell(row) {
  document.getElementById("player-clock").textContent = `${dateIn(tape.time[row] * 1000, head.playerZone)} ${clockTime(tape.time[row] * 1000, head.playerZone)}`;
  for (const name of ANGLES) {
    for (const axis of ["azimuth", "elevation"]) {
      const value = tape.columns[`${name}_${axis}_deg`][row];
      document.querySelector(`[data-value="${name}_${axis}_deg"]`).textContent = value === null ? "–" : angle(value);
    }
  }
  document.getElementById("player-error").textContent = tape.error[row] === null ? "–" : angle(tape.error[row], 3);
  document.getElementById("player-activity").textContent = words(tape.activities[tape.columns.activity[row]] ?? "–");
  scrubber.value = String(at);
  scrubber.setAttribute("aria-valuetext", document.getElementById("player-clock").textContent);
  for (const plot of plots) plot.setCursor({ left: plot.valToPos(tape.time[row], "x"), top: plot.cursor.top ?? 0 }, false);
}

function seek(elapsed) {
  at = Math.min(tape.columns.elapsed_s[tape.columns.elapsed_s.length - 1], Math.max(0, elapsed));
  show();
}

const speed = () => Number(document.querySelector('input[name="player-speed"]:checked').value);

function step(now) {
  if (!playing) return;
  const end = tape.columns.elapsed_s[tape.columns.elapsed_s.length - 1];
  seek(at + ((now - tickAt) / 1000) * speed());
  tickAt = now;
  if (at >= end) play(false); else requestAnimationFrame(step);
}

function play(wanted) {
  playing = wanted;
  key.querySelector("span").textContent = playing ? _("Pause") : _("Play");
  key.querySelector("path").setAttribute("d", playing ? "M7 4h4v16H7zM14 4h4v16h-4z" : "M7 4.5v15l12-7.5z");
  if (!playing) {
    show();
    return;
  }
  if (at >= tape.columns.elapsed_s[tape.columns.elapsed_s.length - 1]) at = 0;
  tickAt = performance.now();
  requestAnimationFrame(step);
}

async function open() {
  tape = await read(head.recording, head.begin, head.playerZone);
  if (!tape.time.length) {
    said.textContent = _("This recording has no samples.");
    return;
  }
  if (head.other) other = await read(head.other, head.otherBegin, head.otherZone);
  scrubber.max = String(tape.columns.elapsed_s[tape.columns.elapsed_s.length - 1]);
  said.textContent = other ? _("Overlaid in red: {title}.", { title: head.otherTitle }) : "";
  key.addEventListener("click", () => play(!playing));
  scrubber.addEventListener("input", () => { at = Number(scrubber.value); play(false); });
  let drawing = draw();
  addEventListener("theme", () => { drawing = draw(); });
  offerToPrint(() => drawing);
  await drawing;
}

// What has not been looked at yet is drawn first, and has a frame's time to come to the paper.
function offerToPrint(drawing) {
  const paper = document.getElementById("player-print");
  paper.hidden = false;
  paper.addEventListener("click", async () => {
    play(false);
    printing();
    await drawing();
    requestAnimationFrame(() => requestAnimationFrame(() => print()));
  });
}

open().catch((error) => { said.textContent = _("The samples could not be read: {why}", { why: error.message }); });
