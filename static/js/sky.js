// A small picture of the sky that a clock means: its colors, and the sun at its height or below the horizon.

import { angle } from "./format.js";
import { _ } from "./i18n.js";

const PARTS = ["top", "middle", "low", "far", "near"];
// By the sun's elevation, degrees: the sky at the top, in the middle, and at the horizon; the ground far away and near.
const SKIES = [
  [-18, "070b16", "0d1424", "18213a", "10161f", "0b1016"],
  [-6, "16223f", "3a3d66", "a8655c", "2c2c34", "191c22"],
  [0, "34548a", "8a86a8", "f2a765", "6f6455", "3f3d38"],
  [6, "4677ad", "a9bdd0", "f8d6a2", "a09273", "6d6754"],
  [15, "4f8cc8", "a5c8e4", "f1ead6", "b9b394", "8a8668"],
  [30, "3f86cb", "8fc0e6", "e3eff6", "bdbb9c", "8f8d6d"],
  [60, "2f78c4", "7db4e4", "dbebf6", "c3bf9f", "96926f"],
];
const HORIZON = 65;
const ABOVE = 52;
const BELOW = 26;

const mixed = (one, two, share) => [0, 2, 4].map((at) => {
  const [from, to] = [one, two].map((color) => Number.parseInt(color.slice(at, at + 2), 16));
  return Math.round(from + (to - from) * share);
});

function colors(elevationDeg) {
  const after = Math.max(1, Math.min(SKIES.length - 1, SKIES.findIndex(([from]) => from > elevationDeg)));
  const [one, two] = elevationDeg >= 60 ? [SKIES.at(-1), SKIES.at(-1)] : [SKIES[after - 1], SKIES[after]];
  const share = one === two ? 0 : Math.max(0, (elevationDeg - one[0]) / (two[0] - one[0]));
  return PARTS.map((part, index) => [part, `rgb(${mixed(one[index + 1], two[index + 1], share).join(" ")})`]);
}

export function drawSky(svg, sun) {
  if (!svg) return;
  svg.toggleAttribute("hidden", !sun);
  if (!sun) return;
  const elevationDeg = sun.apparent_elevation_deg;
  const sine = Math.sin((elevationDeg * Math.PI) / 180);
  for (const [part, color] of colors(elevationDeg)) svg.style.setProperty(`--sky-${part}`, color);
  svg.toggleAttribute("data-down", elevationDeg <= 0);
  const place = `translate(0 ${(HORIZON - sine * (sine > 0 ? ABOVE : BELOW)).toFixed(1)})`;
  for (const disc of svg.querySelectorAll(".sky-sun, .sky-below")) disc.setAttribute("transform", place);
}

export function sunWords(sun) {
  if (!sun) return "–";
  const elevation = angle(sun.apparent_elevation_deg, 1);
  if (sun.apparent_elevation_deg <= 0) return _("Sun below the horizon, {elevation}", { elevation });
  return _("Sun {azimuth}, {elevation}", { azimuth: angle(sun.azimuth_deg, 1), elevation });
}
