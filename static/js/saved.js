// Says what was saved: what is stored now against what was stored before, below the word that it is saved.

import { _ } from "./i18n.js";

const MOST = 8;
const AFTER_RELOAD = "saved-before-reload";
const NOTHING = "–";

const textOf = (element) => element?.textContent.trim().replace(/\s+/g, " ") ?? "";

function labelOf(field) {
  const group = field.closest("[role=radiogroup]");
  if (group && field.type === "radio") return group.getAttribute("aria-label") ?? "";
  const label = field.labels?.[0];
  return textOf(label?.querySelector("span") ?? label) || (field.getAttribute("aria-label") ?? "");
}

const groupOf = (field) => textOf(field.closest("fieldset")?.querySelector("legend") ?? field.closest("section")?.querySelector("h2"));

function shownOf(field, value) {
  if (field.type === "radio") return textOf(field.labels?.[0]);
  if (field.type === "checkbox") return value ? _("yes") : _("no");
  if (field.tagName === "SELECT") return textOf([...field.options].find((one) => one.value === value));
  const unit = textOf(field.parentElement?.querySelector(":scope > span"));
  return value === "" ? NOTHING : `${value}${unit ? ` ${unit}` : ""}`;
}

// Returns what fields hold, by name and place among those of that name: each with its label, and as it is shown.
export function heldBy(fields, valueOf, isSecret) {
  const named = fields.map(labelOf);
  const held = {};
  const seen = {};
  for (const [at, field] of fields.entries()) {
    const place = `${field.name} ${seen[field.name] = (seen[field.name] ?? -1) + 1}`;
    const value = valueOf(field);
    if (field.type === "radio" && !value) continue;
    const label = named[at];
    const group = groupOf(field);
    const isOne = field.type === "radio" || named.filter((one) => one === label).length === 1;
    const secret = isSecret(field);
    held[field.type === "radio" ? field.name : place] = {
      label: isOne || !group ? label : `${group}, ${label}`, secret, shown: secret ? "" : shownOf(field, value), value,
    };
  }
  return held;
}

// What differs between what was held and what is held, in lines; what is not there any more is shown as nothing.
export function linesOf(before, now) {
  const lines = [];
  for (const place of new Set([...Object.keys(before), ...Object.keys(now)])) {
    const [old, one] = [before[place], now[place]];
    const { label, secret } = one ?? old;
    const [was, is] = [old?.shown ?? NOTHING, one?.shown ?? NOTHING];
    const differs = secret ? old?.value !== one?.value : was !== is;
    if (label && differs) lines.push(secret ? label : `${label}: ${was} → ${is}`);
  }
  return [...new Set(lines)];
}

function list(lines) {
  const shown = document.createElement("div");
  shown.className = "saved-what";
  if (!lines.length) {
    shown.textContent = _("No values were changed.");
    return shown;
  }
  const all = document.createElement("ul");
  const more = lines.length > MOST ? [_("and {count} more", { count: lines.length - MOST })] : [];
  for (const line of [...lines.slice(0, MOST), ...more]) all.appendChild(document.createElement("li")).textContent = line;
  shown.append(all);
  return shown;
}

// Where the answer is the page itself, it says so when it is there. Secrets are not stored meanwhile.
export function tellAfterReload(form, before) {
  const known = Object.entries(before).filter(([, { secret }]) => !secret);
  sessionStorage.setItem(AFTER_RELOAD, JSON.stringify({ path: location.pathname, form, before: Object.fromEntries(known) }));
}

export function tell(form, lines) {
  const done = form.querySelector(".outcome .outcome-ok");
  if (done) done.append(list(lines));
}

// `storedBy` returns what the form of a name holds as it was served.
export function start(storedBy) {
  const { path, form, before } = JSON.parse(sessionStorage.getItem(AFTER_RELOAD) ?? "{}");
  sessionStorage.removeItem(AFTER_RELOAD);
  const now = path === location.pathname && storedBy(form);
  if (!now) return;
  const said = document.querySelector("main [role=status].lead, main .outcome-ok");
  const place = said ?? document.querySelector("#heading").parentElement.appendChild(document.createElement("p"));
  if (!said) {
    place.className = "outcome-ok";
    place.setAttribute("role", "status");
    place.textContent = _("Saved.");
  }
  const lines = linesOf(before, now);
  // What the page says to be in use now was set, though no field differs.
  if (lines.length || !("now" in place.dataset)) place.append(list(lines));
}
