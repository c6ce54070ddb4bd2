// Says what was saved: each field that was changed, as it was and as it is, below the word that it is saved.

import { _ } from "./i18n.js";

const MOST = 8;
const AFTER_RELOAD = "saved-before-reload";

const textOf = (element) => element?.textContent.trim().replace(/\s+/g, " ") ?? "";

function labelOf(field) {
  const group = field.closest("[role=radiogroup]");
  if (group && field.type === "radio") return group.getAttribute("aria-label") ?? "";
  const label = field.labels?.[0];
  return textOf(label?.querySelector("span") ?? label) || (field.getAttribute("aria-label") ?? "");
}

const groupOf = (field) => textOf(field.closest("fieldset")?.querySelector("legend") ?? field.closest("section")?.querySelector("h2"));

function valueOf(field, value) {
  if (field.type === "checkbox") return value ? _("yes") : _("no");
  if (field.tagName === "SELECT") return textOf([...field.options].find((one) => one.value === value));
  const unit = textOf(field.parentElement?.querySelector(":scope > span"));
  return value === "" ? "–" : `${value}${unit ? ` ${unit}` : ""}`;
}

function lineOf(field, { from, to, secret }, named) {
  const label = labelOf(field);
  const group = groupOf(field);
  const what = group && named.filter((one) => one === label).length > 1 ? `${group}, ${label}` : label;
  if (secret) return what;
  if (field.type === "radio") return to ? `${what}: ${textOf(field.labels?.[0])}` : "";
  return `${what}: ${valueOf(field, from)} → ${valueOf(field, to)}`;
}

// What differs in a form from what was stored, in lines; `changed` are its fields with what they were and are.
export function linesOf(form, changed) {
  const named = [...form.elements].map(labelOf);
  return [...new Set([...changed].map(([field, change]) => lineOf(field, change, named)).filter(Boolean))];
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

// Where the answer is the page itself, it says so when it is there.
export function tellAfterReload(lines) {
  sessionStorage.setItem(AFTER_RELOAD, JSON.stringify({ path: location.pathname, lines }));
}

export function tell(form, lines) {
  const done = form.querySelector(".outcome .outcome-ok");
  if (done) done.append(list(lines));
}

export function start() {
  const { path, lines } = JSON.parse(sessionStorage.getItem(AFTER_RELOAD) ?? "{}");
  sessionStorage.removeItem(AFTER_RELOAD);
  if (path !== location.pathname) return;
  const said = document.querySelector("main [role=status].lead, main .outcome-ok");
  const place = said ?? document.querySelector("#heading").parentElement.appendChild(document.createElement("p"));
  if (!said) {
    place.className = "outcome-ok";
    place.setAttribute("role", "status");
    place.textContent = _("Saved.");
  }
  place.append(list(lines));
}
