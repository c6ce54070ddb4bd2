// What the controller tells first: the state in the bar with the most urgent message, all messages of the tracker behind
// it, and the card of its own page. The order and the words are the controller's; templates/_message.html says the same.

import { onlyAsRead } from "./as_read.js";
import { facts } from "./facts.js";
import { holding } from "./holding.js";
import { clockTime, duration, shown } from "./format.js";
import { _ } from "./i18n.js";
import { live } from "./live.js";

const says = document.getElementById("says");
const list = document.querySelector(".says-messages");
const card = document.getElementById("urgent");
const isHeld = holding(".message");

function setText(element, text) {
  if (element && element.textContent !== text) element.textContent = text;
}

// A motion that is announced says in how many seconds it begins.
function leftOf(message, tracker) {
  const warning = tracker.warning;
  return warning && message?.code === warning.reason.code ? duration(Math.ceil(warning.remaining_s)) : "";
}

// When an event was; since when what is so now.
function timeOf({ priority, since }) {
  if (!since) return "";
  const time = clockTime(since, live.zone);
  return priority < facts.urgency.information ? _("since {time}", { time }) : time;
}

// What the state in the bar says already is not said again below it.
function headOf(message, tracker) {
  if (!message) return "";
  const where = message.where ? `${message.tracker_id} ${message.where}: ` : "";
  const of = [message.by && shown(message.by, "who"), timeOf(message)].filter(Boolean);
  return `${where}${message.code === tracker?.state ? message.message : message.title}${of.length ? ` · ${of.join(", ")}` : ""}`;
}

function linkOf({ code }, tracker) {
  if (tracker.fault?.code === code) return facts.messages.fault;
  return facts.messages[code] ?? null;
}

function fill(item, message, tracker) {
  item.dataset.code = message.code;
  item.dataset.priority = message.priority;
  for (const shape of item.querySelectorAll("[data-shape]")) shape.hidden = Number(shape.dataset.shape) !== message.priority;
  setText(item.querySelector(".message-left"), leftOf(message, tracker));
  setText(item.querySelector(".message-title"), headOf(message));
  setText(item.querySelector(".message-text"), message.message);
  setText(item.querySelector(".message-hint"), message.hint);
  const link = item.querySelector("a");
  const leads = linkOf(message, tracker);
  link.hidden = !leads;
  if (leads) {
    link.href = `/trackers/${encodeURIComponent(tracker.tracker_id)}${leads[0]}`;
    setText(link, leads[1]);
  }
  const form = item.querySelector("form");
  form.hidden = !message.calls;
  form.elements.alarm_id.value = message.alarm_id;
}

// Items are kept by what they tell; only what has another place is moved, so that the focus stays where it is.
function paintList(tracker) {
  const before = new Map([...list.children].map((item) => [item.dataset.code, item]));
  tracker.messages.forEach((message, place) => {
    const item = before.get(message.code) ?? made();
    before.delete(message.code);
    if (list.children[place] !== item) list.insertBefore(item, list.children[place] ?? null);
    fill(item, message, tracker);
  });
  for (const gone of before.values()) gone.remove();
}

function made() {
  const item = document.getElementById("message-item").content.firstElementChild.cloneNode(true);
  window.htmx?.process(item);
  return item;
}

// Below the state stands the first message, or the stop behind one that the state says; told_in_bar says the same.
function lineOf([first, second], tracker) {
  return first?.code === tracker.state && second?.code === "stopped" ? second : first;
}

function paintSays(first, tracker) {
  says.dataset.code = first?.code ?? "";
  says.dataset.priority = first ? Math.min(...(tracker?.messages ?? [first]).map(({ priority }) => priority)) : "";
  setText(says.querySelector(".says-first"), headOf(tracker ? lineOf(tracker.messages, tracker) : first, tracker));
  if (!tracker) return;
  setText(says.querySelector(".message-left"), leftOf(first, tracker));
  tellAloud(tracker);
}

// What is dangerous is read aloud when it begins, and not again while only its time passes.
let loud = "";
function tellAloud(tracker) {
  const urgent = tracker.messages.filter((message) => message.priority <= facts.messages.in_page || message.code === tracker.warning?.reason.code);
  const codes = urgent.map(({ code }) => code).join();
  if (codes === loud) return;
  loud = codes;
  setText(document.getElementById("says-alert"), urgent.length ? headOf(urgent[0]) : "");
}

function paint({ site, tracker }) {
  if (live.trackerId && !tracker) return;
  const [first] = tracker ? tracker.messages : site.messages;
  paintSays(first, tracker);
  if (tracker) {
    if (!isHeld()) {
      paintList(tracker);
      paintCard(tracker);
    }
    endAnswers(tracker);
    return;
  }
  says.querySelector("a").href = first?.tracker_id ? `/trackers/${encodeURIComponent(first.tracker_id)}` : "/alarms";
}

// What a button answered is no longer the last thing that happened once something else has.
let happened = null;
let did = null;
function endAnswers(tracker) {
  const now = JSON.stringify([tracker.state, tracker.messages.filter(({ since }) => since).map(({ code, since }) => [code, since])]);
  // What was refused because of what the tracker did is no longer so.
  if (did !== null && did !== tracker.state) document.querySelector(".question-place .outcome-refused")?.remove();
  did = tracker.state;
  if (happened !== null && happened !== now) {
    for (const done of document.querySelectorAll("form[data-moves] .outcome-ok")) done.remove();
  }
  happened = now;
}

function paintCard(tracker) {
  if (!card) return;
  const first = tracker.messages.find(({ priority }) => priority <= facts.messages.in_page);
  card.hidden = !first;
  // Nobody acknowledges by Enter what came under the focus.
  if (card.dataset.code !== first?.code && card.contains(document.activeElement)) document.activeElement.blur();
  if (first) fill(card, first, tracker);
}

// Without the controller nothing is acknowledged.
function paintLink() {
  for (const key of document.querySelectorAll(".message form button")) key.disabled = live.link !== "live";
}

export function start() {
  if (!says) return;
  if (card) onlyAsRead(card, () => card.dataset.code);
  if (list) onlyAsRead(list.parentElement, () => [...list.children].map((item) => item.dataset.code).join());
  live.on("state", paint);
  live.on("link", paintLink);
}
