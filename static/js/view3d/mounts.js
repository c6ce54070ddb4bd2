// How the panel hangs in the landscape on every mount; app/tracker/mounts/frame.py says the same on the machine.

import { RAD, add, cross, dot, times, towards } from "./space.js";

const AZIMUTH_ELEVATION = "azimuth-elevation";
const VERTICAL = "vertical-single-axis";
const HORIZONTAL = "horizontal-single-axis";
const EQUATORIAL = "equatorial";

const tiltOf = (mount) => (mount.kind === HORIZONTAL ? 0 : mount.kind === VERTICAL ? 90 : mount.axis_tilt_deg);
const handOf = (mount) => (mount.kind === EQUATORIAL && Math.cos(mount.axis_azimuth_deg * RAD) > 0 ? -1 : 1);

// The frame of the first axis: at angle zero the panel's normal lies along `zero`, at 90 degrees along `across`
// (times `hand`); the second angle lifts it towards `axis`.
export function frameOf(mount) {
  if (mount.kind === AZIMUTH_ELEVATION) return { across: [1, 0, 0], zero: [0, 1, 0], axis: [0, 0, 1], hand: 1 };
  const [azimuth, tilt, hand] = [mount.axis_azimuth_deg, tiltOf(mount), handOf(mount)];
  const dipping = towards(azimuth, -tilt);
  return { across: towards(azimuth + 90, 0), zero: towards(azimuth, 90 - tilt), axis: times(dipping, -hand), hand };
}

// First and second angle of a direction of the sky, degrees; an azimuth-elevation mount has them already.
export function anglesOf(mount, { azimuth, elevation }) {
  if (mount.kind === AZIMUTH_ELEVATION) return { first: azimuth, second: elevation };
  const { across, zero, axis, hand } = frameOf(mount);
  const normal = towards(azimuth, elevation);
  const above = Math.max(-1, Math.min(1, dot(normal, axis)));
  return { first: (hand * Math.atan2(dot(normal, across), dot(normal, zero))) / RAD, second: Math.asin(above) / RAD };
}

// Where the first axis points the panel while the second is at zero.
export function outward(frame, first) {
  const turn = frame.hand * first * RAD;
  return add(times(frame.across, Math.sin(turn)), frame.zero, Math.cos(turn));
}

// Three unit vectors of the panel at axis angles: to its right, up along it, and out of its front.
export function pose(mount, { first, second }) {
  const frame = frameOf(mount);
  const out = outward(frame, first);
  const [sin, cos] = [Math.sin(second * RAD), Math.cos(second * RAD)];
  const normal = add(times(out, cos), frame.axis, sin);
  const up = add(times(frame.axis, cos), out, -sin);
  return { right: cross(up, normal), up, normal, out };
}
