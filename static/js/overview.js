// The overview: the most urgent tracker above all, how many are in each state, and all of them in the order of urgency,
// or those in one state. Nothing moves under a finger: what changes the list waits until it is let go.

import { onlyAsRead } from "./as_read.js";
import { facts } from "./facts.js";
import { words } from "./format.js";
import { holding } from "./holding.js";
import { live, paint } from "./live.js";
import { _ } from "./i18n.js";

const list = document.getElementById("trackers");
const counts = document.getElementById("counts");
const urgent = document.getElementById("site-urgent");
const items = new Map([...list?.children ?? []].map((item) => [item.dataset.item, item]));
const { first: firstStates } = facts.urgency;
const rankOf = ({ state }) => (firstStates.includes(state) ? firstStates.indexOf(state) : firstStates.length);
let wanted = counts?.querySelector('[aria-pressed="true"]').dataset.state ?? "";
let arranged = "";
let alarmed = "";
const isHeld = holding("main", () => follow());

function setText(element, text) {
  if (element && element.textContent !== text) element.textContent = text;
}

function setHidden(element, hidden) {
  if (element && element.hidden !== hidden) element.hidden = hidden;
}

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

const priorityOf = (one) => Math.min(...one.messages.map(({ priority }) => priority), facts.urgency.information);

// The color of a tracker: the priority of its most urgent alarm, 0 without any.
export const colorOf = (one) => (priorityOf(one) < facts.urgency.information ? priorityOf(one) : 0);

// The first thing to know about a tracker; what its state says already is told with its cause.
export function troubleOf(one) {
  const [first] = one.messages;
  if (!first) return "";
  return first.code === one.state && first.message ? first.message : first.title;
}

function showShape(holder, priority) {
  for (const shape of holder.querySelectorAll("[data-shape]")) setHidden(shape, Number(shape.dataset.shape) !== priority);
}

function paintGlance(item) {
  const one = live.trackerOf(item.dataset.item);
  if (!one) return;
  const color = colorOf(one);
  item.dataset.priority = color;
  item.dataset.look = facts.looks[one.state] ?? "";
  showShape(item.querySelector(".glance-trouble"), color);
  setText(item.querySelector(".glance-trouble > span"), troubleOf(one));
  setHidden(item.querySelector("[data-urgent]"), color !== 1);
  setHidden(item.querySelector("[data-calm]"), color === 1);
}

function paintCounts() {
  const found = new Map();
  for (const one of live.site.trackers) {
    if (!found.has(one.state)) found.set(one.state, []);
    found.get(one.state).push(one);
  }
  for (const key of counts.querySelectorAll(".count")) {
    const { state } = key.dataset;
    const mine = state ? found.get(state) ?? [] : live.site.trackers;
    const worst = facts.urgency.in_danger.includes(state) ? Math.min(...mine.map(priorityOf), facts.urgency.information) : facts.urgency.information;
    setText(key.querySelector("b"), String(mine.length));
    setHidden(key, !mine.length && state !== wanted);
    key.dataset.priority = worst < facts.urgency.information ? worst : 0;
    showShape(key, worst);
    const isPressed = state === wanted;
    key.setAttribute("aria-pressed", String(isPressed));
    key.value = isPressed ? "" : state;
  }
}

function address(parts) {
  const asked = new URLSearchParams(location.search);
  for (const [name, value] of Object.entries(parts)) value ? asked.set(name, value) : asked.delete(name);
  return `/${asked.size ? `?${asked}` : ""}`;
}

function choose(state) {
  wanted = state;
  history.replaceState(history.state, "", address({ state }));
  for (const key of document.querySelectorAll("[data-layout]")) key.href = address({ layout: key.dataset.layout });
  arranged = "";
  paintCounts();
  arrange(true);
}

// Where the trackers belong: most urgent first, among equals as the site has them, and which of them are shown.
function arrange(isChosen = false) {
  const known = live.site.trackers.filter((one) => items.has(one.tracker_id));
  const now = known.map((one) => `${priorityOf(one)}.${rankOf(one)}.${wanted ? one.state : ""}`).join();
  const first = known.filter((one) => priorityOf(one) === 1).map((one) => one.tracker_id).join();
  const isRead = list.contains(document.activeElement) && arranged !== "" && first === alarmed;
  if (now === arranged || (!isChosen && (isHeld() || isRead))) return;
  arranged = now;
  alarmed = first;
  known.sort((one, other) => priorityOf(one) - priorityOf(other) || rankOf(one) - rankOf(other));
  const sorted = known.map((one) => items.get(one.tracker_id));
  // Only what has another place is moved: what has the focus keeps it.
  sorted.forEach((item, place) => { if (list.children[place] !== item) list.insertBefore(item, list.children[place]); });
  for (const one of known) setHidden(items.get(one.tracker_id), wanted !== "" && one.state !== wanted);
  setHidden(document.getElementById("none-alike"), !wanted || known.some((one) => one.state === wanted));
}

// The tracker above all others is another one only while no finger is on it.
function paintUrgent() {
  const first = live.site.messages.find((message) => message.tracker_id);
  const one = first && first.priority <= facts.urgency.on_top ? live.trackerOf(first.tracker_id) : null;
  const isOther = (one?.tracker_id ?? "") !== urgent.dataset.tracker;
  if (isOther && isHeld()) return;
  setHidden(urgent, !one);
  if (isOther) urgent.querySelector(".outcome").replaceChildren();
  urgent.dataset.tracker = one?.tracker_id ?? "";
  if (!one) return;
  const id = one.tracker_id;
  const path = `/trackers/${encodeURIComponent(id)}`;
  urgent.dataset.priority = first.priority;
  showShape(urgent, first.priority);
  setText(urgent.querySelector("h2"), `${id} ${one.name}: ${first.title}`);
  setText(urgent.querySelector("[data-part=message]"), first.message);
  setText(urgent.querySelector("[data-part=hint]"), first.hint);
  document.getElementById("urgent-open").href = path;
  setText(document.getElementById("urgent-open"), _("Open {tracker}", { tracker: id }));
  const form = urgent.querySelector("form");
  form.setAttribute("action", `${path}/stow`);
  form.setAttribute("hx-post", `${path}/stow`);
  form.elements.position.value = one.protection?.protection === "snow" ? "snow" : "wind";
  setText(form.querySelector("button > span"), _("Stow {tracker}", { tracker: id }));
  paintMore(one);
  if (isOther) paint();
}

function paintMore(one) {
  const more = document.getElementById("urgent-more");
  if (!more) return;
  const count = live.site.trackers.filter(({ state }) => state === one.state).length - 1;
  setHidden(more, !count || !facts.urgency.in_danger.includes(one.state));
  more.href = address({ state: one.state });
  setText(more, _("{count} more", { count }));
  more.ariaLabel = _("{count} more: {state}", { count, state: words(one.state) });
}

function follow() {
  if (!live.site) return;
  paintUrgent();
  if (!counts) return;
  paintCounts();
  look();
  arrange();
}

// Whoever presses what has just become another tracker, or has just moved, means what was there before.
const look = urgent && onlyAsRead(urgent, () => `${urgent.dataset.tracker} ${urgent.offsetTop}`, (target) => target.closest("#urgent-more"));
list?.addEventListener("focusout", () => setTimeout(follow));
counts?.addEventListener("submit", (event) => {
  event.preventDefault();
  choose(event.submitter.value);
});
document.getElementById("urgent-more")?.addEventListener("click", (event) => {
  event.preventDefault();
  choose(new URL(event.currentTarget.href).searchParams.get("state") ?? "");
});

live.on("state", () => {
  for (const svg of document.querySelectorAll("[data-bar]")) paintBar(svg, live.trackerOf(svg.closest("[data-tracker]").dataset.tracker));
  document.querySelectorAll("li.glance").forEach(paintGlance);
  follow();
});
