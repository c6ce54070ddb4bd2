// A field of trackers as tiles: the state of each, how its panel stands, and its most urgent alarm.

import { facts } from "./facts.js";
import { words } from "./format.js";
import { live } from "./live.js";
import { colorOf, troubleOf } from "./overview.js";

const tiles = [...document.querySelectorAll("[data-tile]")];
const painted = new Map();

// How far the panel is turned from level, as it was measured last; app/web/shell/glances.py says the same on the server.
function tiltOf(one) {
  const known = one.measured ?? one.last_measured;
  return known ? Math.round(known.elevation_deg) - 90 : null;
}

function paintTile(tile) {
  const one = live.trackerOf(tile.dataset.tile);
  if (!one) return;
  const [color, tilt, told] = [colorOf(one), tiltOf(one), `${words(one.state)} ${troubleOf(one)}`];
  const now = [one.state, color, tilt, told].join("|");
  if (painted.get(tile) === now) return;
  painted.set(tile, now);
  tile.dataset.look = facts.looks[one.state] ?? "";
  tile.dataset.priority = color;
  const panel = tile.querySelector(".tile-panel");
  panel.setAttribute("visibility", tilt === null ? "hidden" : "visible");
  panel.setAttribute("transform", `translate(16 12) rotate(${tilt ?? 0})`);
  tile.querySelector("i").textContent = color || "";
  tile.lastElementChild.textContent = told;
}

live.on("state", () => tiles.forEach(paintTile));
