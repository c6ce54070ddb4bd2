// The bodies of a tracker on each mount: posts, axes, rails and panel, and where its panel's middle is.

import { frameOf, pose } from "./mounts.js";
import { add, cross, placed, times, unit } from "./space.js";

const UP = [0, 0, 1];
const SINGLE = { half: 0.62, wide: 0.2 };
const DUAL = { half: 0.27, wide: 0.42 };

const body = (mesh, look, matrix) => ({ mesh, look, matrix });
const cube = (look, { right, up, normal }, at, [width, height, depth]) =>
  body("cube", look, placed(times(right, width), times(up, height), times(normal, depth), at));

// A round bar between two points.
function bar(look, from, to, radius) {
  const along = add(to, from, -1);
  const aside = unit(cross(Math.abs(unit(along)[2]) > 0.9 ? [1, 0, 0] : UP, along));
  return body("tube", look, placed(times(aside, 2 * radius), times(unit(cross(along, aside)), 2 * radius), along, times(add(from, to), 0.5)));
}

// The panel, its frame's two rails, and its middle, which lies before the axis.
function table(size, stand, hub, rails) {
  const middle = add(hub, stand.normal, 0.06);
  const solids = [cube("panel", stand, middle, [size.wide * 2, size.half * 2, 0.022])];
  for (const side of [-0.5, 0.5]) {
    const at = add(add(middle, stand.normal, -0.022), stand[rails], side * (rails === "right" ? size.wide : size.half));
    const [width, height] = rails === "right" ? [0.025, size.half * 1.9] : [size.wide * 1.9, 0.025];
    solids.push(cube("metal", stand, at, [width, height, 0.02]));
  }
  return { middle, solids };
}

function onMast(height) {
  return [
    body("tube", "metal", placed([0.26, 0, 0], [0, 0.26, 0], [0, 0, 0.03], [0, 0, 0.015])),
    bar("metal", [0, 0, 0], [0, 0, height - 0.07], 0.035),
  ];
}

function azimuthElevation(view, stand) {
  const hub = view.hub;
  const { middle, solids } = table(DUAL, stand, hub, "right");
  const bracket = add([0, 0, hub[2] - 0.3], stand.out, 0.05);
  const pushed = add(add(middle, stand.normal, -0.03), stand.up, -0.17);
  return {
    middle,
    solids: [...onMast(hub[2]), ...solids,
      bar("dark", [0, 0, hub[2] - 0.08], [0, 0, hub[2] - 0.02], 0.06),
      bar("dark", add(hub, stand.right, -0.3), add(hub, stand.right, 0.3), 0.024),
      bar("dark", bracket, add(bracket, add(pushed, bracket, -1), 0.55), 0.018),
      bar("metal", bracket, pushed, 0.01)],
  };
}

function equatorial(view, stand, { axis }) {
  const hub = add(view.hub, stand.out, 0.13);
  const { middle, solids } = table(DUAL, stand, hub, "right");
  const [one, other] = [add(view.hub, axis, -0.4), add(view.hub, axis, 0.4)];
  const [low, high] = one[2] < other[2] ? [one, other] : [other, one];
  const aside = unit(cross(Math.abs(axis[2]) > 0.99 ? [0, 1, 0] : UP, axis));
  const foot = (side) => add([high[0], high[1], 0], aside, side * 0.2);
  return {
    middle,
    solids: [...solids, bar("dark", one, other, 0.032), bar("metal", [low[0], low[1], 0], low, 0.03),
      bar("metal", foot(-1), high, 0.024), bar("metal", foot(1), high, 0.024),
      bar("dark", view.hub, hub, 0.035), bar("dark", add(hub, stand.right, -0.24), add(hub, stand.right, 0.24), 0.024)],
  };
}

function row(view, stand, { axis }) {
  const { middle, solids } = table(SINGLE, stand, view.hub, "up");
  const along = (far) => add(view.hub, axis, far);
  const posts = [-0.56, 0, 0.56].map(along).map(([x, y, z]) => bar("metal", [x, y, 0], [x, y, z], 0.022));
  return { middle, solids: [...posts, ...solids, bar("dark", along(-0.72), along(0.72), 0.026)] };
}

function upright(view, stand) {
  const hub = view.hub;
  const { middle, solids } = table(DUAL, stand, hub, "right");
  return {
    middle,
    solids: [...onMast(hub[2]), ...solids, bar("dark", [0, 0, hub[2] - 0.08], [0, 0, hub[2] - 0.02], 0.06),
      bar("dark", add(hub, stand.right, -0.2), add(hub, stand.right, 0.2), 0.024)],
  };
}

const KINDS = {
  "azimuth-elevation": azimuthElevation, equatorial, "horizontal-single-axis": row, "tilted-single-axis": row, "vertical-single-axis": upright,
};

// How high the panel's axis lies, so that nothing touches the ground.
export function hubOf(mount) {
  const { axis } = frameOf(mount);
  switch (mount.kind) {
    case "equatorial": return [0, 0, 0.3 + 0.32 * Math.abs(axis[2])];
    case "tilted-single-axis": return [0, 0, 0.28 + 0.64 * Math.abs(axis[2])];
    case "horizontal-single-axis": return [0, 0, 0.34];
    default: return [0, 0, 0.45];
  }
}

// The bodies at axis angles, the panel's middle, its pose and its outline.
export function machine(view, angles) {
  const stand = pose(view.mount, angles);
  const { solids, middle } = KINDS[view.mount.kind](view, stand, frameOf(view.mount));
  return { solids, middle, stand, outline: outlineOf(view, angles, middle) };
}

// The corners of the panel at axis angles; of another direction about the same middle.
export function outlineOf(view, angles, middle) {
  const { right, up } = pose(view.mount, angles);
  const { half, wide } = KINDS[view.mount.kind] === row ? SINGLE : DUAL;
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([u, v]) => add(add(middle, right, u * wide), up, v * half));
}

// What stands when nobody knows where the panel is.
export const bare = (view) => (view.mount.kind === "equatorial" || KINDS[view.mount.kind] === row ? [] : onMast(view.hub[2]));
