// A field of trackers as tiles: what each does, how its panel stands, and its most urgent alarm.

import { headingOf } from "./alarms.js";
import { facts } from "./facts.js";
import { words } from "./format.js";
import { _ } from "./i18n.js";
import { live } from "./live.js";

const tiles = [...document.querySelectorAll("[data-tile]")];
const urgent = document.getElementById("tile-urgent");
const painted = new Map();

// app/web/shell/glances.py says the same on the server.
function lookOf(one) {
  if (!one.measured) return "unknown";
  return one.approaching ? "under-way" : facts.looks[one.activity] ?? "";
}

// That a tracker does not stow is told although the list of alarms, which is cut off in a storm, may not name it.
function troubles() {
  const worst = new Map();
  const note = (id, trouble) => { if (!(worst.get(id)?.priority <= trouble.priority)) worst.set(id, trouble); };
  for (const alarm of live.site.alarms) {
    if (alarm.tracker_id && !facts.alarms.quiet.includes(alarm.state)) note(alarm.tracker_id, { priority: alarm.priority, title: headingOf(alarm) });
  }
  for (const one of live.site.trackers) if (one.not_stowed) note(one.tracker_id, { priority: 1, title: _("Not stowed") });
  return worst;
}

function paintTile(tile, trouble) {
  const one = live.trackerOf(tile.dataset.tile);
  if (!one) return;
  const tilt = one.measured ? Math.round(one.measured.elevation_deg) - 90 : 0;
  const now = [lookOf(one), trouble?.priority ?? 0, trouble?.title ?? "", one.activity, tilt].join("|");
  if (painted.get(tile) === now) return;
  painted.set(tile, now);
  tile.dataset.look = lookOf(one);
  tile.dataset.priority = trouble?.priority ?? 0;
  tile.querySelector(".tile-panel").setAttribute("transform", `translate(16 12) rotate(${tilt})`);
  tile.querySelector("i").textContent = trouble?.priority ?? "";
  const doing = one.approaching ? _("Moving to the sun") : words(one.activity);
  tile.lastElementChild.textContent = `${doing} ${trouble?.title ?? ""}`;
}

function paintUrgent(worst) {
  const first = live.site.trackers.find((one) => worst.get(one.tracker_id)?.priority === 1);
  urgent.hidden = !first;
  if (!first) return;
  urgent.href = `/trackers/${encodeURIComponent(first.tracker_id)}`;
  urgent.querySelector("[data-name]").textContent = `${first.tracker_id} ${first.name}`;
  urgent.querySelector("[data-trouble]").textContent = worst.get(first.tracker_id).title;
}

live.on("state", () => {
  const worst = troubles();
  for (const tile of tiles) paintTile(tile, worst.get(tile.dataset.tile));
  paintUrgent(worst);
});
