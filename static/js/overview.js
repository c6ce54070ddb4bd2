// The overview: moves the bars of every tracker, counts its alarms, and counts what the trackers do.

import { facts } from "./facts.js";
import { headingOf } from "./alarms.js";
import { live } from "./live.js";
import { _ } from "./i18n.js";


// Where an angle, or its like a turn away, lies on the bar; app/web/shell/glances.py says the same on the server.
export function placeOn(angle, least, most) {
  if (angle === null || angle === undefined) return null;
  let turned = angle;
  while (turned > most && turned - 360 >= least) turned -= 360;
  while (turned < least && turned + 360 <= most) turned += 360;
  return facts.bar * Math.min(1, Math.max(0, (turned - least) / (most - least)));
}

function paintBar(svg, one) {
  const [least, most] = [Number(svg.dataset.least), Number(svg.dataset.most)];
  for (const name of ["setpoint", "measured"]) {
    const mark = svg.querySelector(`[data-at="${name}"]`);
    const at = placeOn(one?.[name]?.[`${svg.dataset.bar}_deg`], least, most);
    mark.setAttribute("visibility", at === null ? "hidden" : "visible");
    if (at !== null) mark.setAttribute("transform", `translate(${at.toFixed(1)} 0)`);
  }
}

// That a tracker does not stow is its own state: the list of alarms is cut off in a storm and may not name it.
function alarmsOf(trackerId) {
  const mine = live.site.alarms.filter((alarm) => alarm.tracker_id === trackerId && !facts.alarms.quiet.includes(alarm.state));
  const unlisted = live.trackerOf(trackerId)?.not_stowed && !mine.some((alarm) => alarm.code === "not_stowed");
  return unlisted ? [...mine, { priority: 1, title: _("Not stowed") }] : mine;
}

function paintAlarms(holder) {
  const mine = alarmsOf(holder.dataset.alarms);
  const worst = Math.min(...mine.map((alarm) => alarm.priority));
  holder.hidden = !mine.length;
  holder.querySelector("b").textContent = String(mine.length);
  holder.querySelector(".glance-trouble").textContent = mine.length ? headingOf(mine.find((alarm) => alarm.priority === worst)) : "";
  const card = holder.closest("[data-tracker]");
  card.querySelector("[data-urgent]").hidden = worst !== 1;
  card.querySelector("[data-calm]").hidden = worst === 1;
  for (const shape of holder.querySelectorAll("[data-priority]")) shape.hidden = Number(shape.dataset.priority) !== worst;
}

function paintCount(item, isMeant) {
  const count = live.site.trackers.filter(isMeant).length;
  item.hidden = !count;
  item.querySelector("b").textContent = String(count);
}

function paintDoing() {
  for (const item of document.querySelectorAll("[data-doing]")) paintCount(item, (one) => !one.approaching && !one.not_stowed && one.activity === item.dataset.doing);
  for (const item of document.querySelectorAll("[data-approaching]")) paintCount(item, (one) => one.approaching && !one.not_stowed);
  for (const item of document.querySelectorAll("[data-unstowed]")) paintCount(item, (one) => Boolean(one.not_stowed));
}

live.on("state", () => {
  for (const svg of document.querySelectorAll("[data-bar]")) paintBar(svg, live.trackerOf(svg.closest("[data-tracker]").dataset.tracker));
  document.querySelectorAll("[data-alarms]").forEach(paintAlarms);
  paintDoing();
});
