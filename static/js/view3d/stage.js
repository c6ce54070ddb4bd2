// Everything that is to be drawn at one instant, as plain data for whichever painter there is.

import { facts } from "../facts.js";
import { hubOf, bare, machine, outlineOf } from "./machines.js";
import { anglesOf, frameOf, outward } from "./mounts.js";
import { spoken } from "../i18n.js";
import { RAD, add, times, towards } from "./space.js";

export const SKY = 1;
const LETTERS = [0, 4, 8, 12].map((point) => spoken.compass[point]);
const LOWEST_SHADOW_DEG = 1.5;
const GROUND_Z = 0.003;
const onGround = ([x, y]) => [x, y, GROUND_Z];

// What stays: the mount, its limits, the day's path and hours, the horizon; directions are azimuth and elevation.
export function viewOf(data) {
  const view = { ...data, hub: hubOf(data.mount), frame: frameOf(data.mount) };
  const [path, scaled] = [daysPath(view), firstScale(view)];
  return { ...view, scaled, fixed: [...compass(), ...(scaled?.lines ?? []), ...skyline(view), ...path.lines],
    marks: [...letters(), ...path.marks, ...(scaled?.marks ?? [])] };
}

export { anglesOf };
const inSky = (view, azimuth, elevation) => add(view.hub, towards(azimuth, elevation, SKY));

function letters() {
  return LETTERS.map((words, index) => ({ kind: "text", words, at: towards(index * 90, 0, 1.12), size: 18, weight: 700 }));
}

function compass() {
  const ring = (radius) => Array.from({ length: 73 }, (_, index) => onGround(towards(index * 5, 0, radius)));
  const ticks = Array.from({ length: 36 }, (_, index) => index * 10).map((azimuth) => ({
    points: [towards(azimuth, 0, azimuth % 30 ? 0.965 : 0.93), towards(azimuth, 0, 1)].map(onGround), colour: "line", width: azimuth % 30 ? 1 : 2,
  }));
  const through = [0, 90].map((azimuth) => ({ points: [towards(azimuth, 0, 1), towards(azimuth + 180, 0, 1)].map(onGround), colour: "hair", width: 1.2 }));
  return [{ points: ring(1), colour: "line", width: 1.6 }, { points: ring(0.5), colour: "hair", width: 1 }, ...ticks, ...through];
}

function skyline(view) {
  if (!view.horizon.length) return [];
  return [{ points: view.horizon.map(([azimuth, elevation]) => inSky(view, azimuth, elevation)), colour: "second", width: 2, dash: [2, 3] }];
}

// Where an axis turns: an arc about a centre with a stop at each end, and the angle written there.
function scale(centre, at, [least, most], radius) {
  const count = Math.max(2, Math.ceil((most - least) / 4));
  const angles = Array.from({ length: count + 1 }, (_, index) => least + ((most - least) * index) / count);
  const spot = (angle, factor) => add(centre, at(angle), radius * factor);
  const ends = most - least >= 360 ? [least] : [least, most];
  return {
    lines: [{ points: angles.map((angle) => spot(angle, 1)), colour: "second", width: 2.5 },
      ...ends.map((angle) => ({ points: [spot(angle, 0.9), spot(angle, 1.1)], colour: "text", width: 3.5 }))],
    marks: ends.map((angle) => ({ kind: "text", words: degrees(angle), at: spot(angle, 1.24), size: 13, weight: 600 })),
    pointer: (angle) => ({ points: [spot(angle, 0.86), spot(angle, 1.14)], colour: "blue", width: 4 }),
  };
}

const degrees = (value) => `${Math.round(value)}°`.replace("-", "−");

// The scale of the first axis; of a recording from before limits were kept there is none.
function firstScale(view) {
  if (!view.first) return null;
  const turned = (angle) => outward(view.frame, angle);
  switch (view.mount.kind) {
    case "azimuth-elevation": case "vertical-single-axis": return scale([0, 0, 2 * GROUND_Z], turned, view.first, 0.74);
    case "equatorial": return scale(add(view.hub, lowEnd(view), 0.46), turned, view.first, 0.26);
    default: return scale(add(view.hub, lowEnd(view), 0.76), turned, view.first, 0.24);
  }
}

// The end of the first axis that dips, or the one that it is named after.
const lowEnd = ({ frame }) => times(frame.axis, -frame.hand);

function moving(view, angles) {
  const drawn = { lines: view.scaled ? [view.scaled.pointer(angles.first)] : [], marks: [] };
  if (!view.second) return drawn;
  const out = outward(view.frame, angles.first);
  const lifted = (angle) => add(times(out, Math.cos(angle * RAD)), view.frame.axis, Math.sin(angle * RAD));
  const second = scale(view.hub, lifted, view.second, 0.62);
  return { lines: [...drawn.lines, ...second.lines, second.pointer(angles.second)], marks: second.marks };
}

function daysPath(view) {
  const lines = [];
  let points = [];
  for (const [azimuth, elevation] of [...view.arc, [0, -90]]) {
    if (elevation >= facts.sky.set_deg) { points.push(inSky(view, azimuth, elevation)); continue; }
    if (points.length > 1) lines.push({ points, colour: "second", width: 2.4 });
    points = [];
  }
  const marks = [];
  for (const [words, azimuth, elevation] of view.hours) {
    const at = inSky(view, azimuth, elevation);
    lines.push({ points: [at, add(view.hub, towards(azimuth, elevation, SKY * 0.955))], colour: "second", width: 2 });
    marks.push({ kind: "text", words, at: add(view.hub, towards(azimuth, elevation, SKY * 1.07)), size: 13, weight: 400 });
  }
  return { lines, marks };
}

function sunlight(view, sun, middle) {
  const at = inSky(view, sun.azimuth, sun.elevation);
  const up = sun.elevation >= facts.sky.set_deg;
  const marks = [{ kind: up ? "sun" : "sunk", words: "", at, size: 26 }];
  if (!up) return { lines: [], marks };
  const below = onGround([at[0], at[1]]);
  const lines = [
    { points: [at, below], colour: "line", width: 1, dash: [3, 5] },
    { points: [onGround([0, 0]), below], colour: "line", width: 1, dash: [3, 5] },
  ];
  if (middle && sun.elevation > -1) lines.push({ points: [middle, at], colour: "text", width: 1.4, dash: [2, 5] });
  return { lines, marks };
}

function panelOf(view, angles) {
  const { solids, middle, stand, outline } = machine(view, angles);
  const tip = add(middle, stand.normal, 0.42);
  const barbs = [-1, 1].map((side) => add(add(tip, stand.normal, -0.06), stand.right, side * 0.025));
  return {
    solids, middle, normal: stand.normal,
    lines: [{ points: [...outline, outline[0]].map((point) => add(point, stand.normal, 0.013)), colour: "outline", width: 2.4 },
      { points: [middle, tip], colour: "blue", width: 4 }, { points: [barbs[0], tip, barbs[1]], colour: "blue", width: 4 }],
  };
}

function wanted(view, panel, target, middle) {
  if (!target || Math.abs(target.first - panel.first) + Math.abs(target.second - panel.second) <= 1) return [];
  const outline = outlineOf(view, target, middle);
  return [{ points: [...outline, outline[0]], colour: "second", width: 2, dash: [7, 6] }];
}

// What never moves is `fixed`, always the same list. `now`: the sun as {azimuth, elevation}, panel and target as {first, second}; null is what is not known.
export function stageOf(view, now) {
  const machineNow = now.panel && panelOf(view, now.panel);
  const limits = now.panel ? moving(view, now.panel) : { lines: [], marks: [] };
  const light = now.sun ? sunlight(view, now.sun, machineNow?.middle) : { lines: [], marks: [] };
  const rays = now.sun && now.sun.elevation > LOWEST_SHADOW_DEG ? towards(now.sun.azimuth, now.sun.elevation) : null;
  return {
    solids: machineNow ? machineNow.solids : bare(view),
    fixed: view.fixed,
    lines: [...limits.lines, ...light.lines, ...(machineNow?.lines ?? []),
      ...(machineNow ? wanted(view, now.panel, now.target, machineNow.middle) : [])],
    marks: [...view.marks, ...limits.marks, ...light.marks],
    rays,
    normal: machineNow?.normal ?? null,
  };
}
