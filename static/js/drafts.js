// What was typed outlives a reload, in this tab: it comes back with a word about it, until it is saved or discarded.
// Secrets are never stored: of these only that they were typed, so that the page can say that they are gone.

import { loadAgain } from "./reload.js";
import { _ } from "./i18n.js";
import { heldBy, linesOf, start as startSaying, tell as tellSaved, tellAfterReload } from "./saved.js";

const WORTH_IT = "main form:is(.form, [data-keep])[method=post]:not(.action)";
const SENT = "typed-and-sent";
const SKIPPED = new Set(["file", "submit", "button"]);
const SECRET_TYPED = "secret typed";
const ORDER_FIELDS = new Set(["back", "issued_at", "key", "epoch"]);
const ASKS_FIRST = /^\/(login|prove)\b/;
const DRAWN = /_drawn$/;

const placeOf = (form) => `typed:${location.pathname}:${form.id || form.getAttribute("action")}`;

const isSecret = (field) => field.type === "password" || "secret" in field.dataset;
const kept = (field) => field.name && !SKIPPED.has(field.type) && !ORDER_FIELDS.has(field.name)
  && (field.type !== "hidden" || DRAWN.test(field.name));

function servedAt(field) {
  if (field.type === "checkbox" || field.type === "radio") return field.defaultChecked;
  if (field.tagName === "SELECT") return [...field.options].find((one) => one.defaultSelected)?.value ?? field.options[0]?.value ?? "";
  return field.type === "hidden" ? field.dataset.served ?? "" : field.defaultValue;
}

const nowOf = (field) => (field.type === "checkbox" || field.type === "radio" ? field.checked : field.value);
const nameOf = (field) => (field.type === "radio" ? `${field.name}=${field.value}` : field.name);

const heldIn = (form, valueOf) => heldBy([...form.elements].filter((field) => kept(field) && field.type !== "hidden"), valueOf, isSecret);
const storedIn = (form) => heldIn(form, servedAt);

function changes(form) {
  const found = {};
  for (const field of form.elements) {
    if (!kept(field) || nowOf(field) === servedAt(field)) continue;
    if (isSecret(field)) found[SECRET_TYPED] = true;
    else found[nameOf(field)] = { from: servedAt(field), to: nowOf(field) };
  }
  return found;
}

// What is stored now is what the next change differs from.
function settle(field, value) {
  if (field.type === "checkbox" || field.type === "radio") field.defaultChecked = value;
  else if (field.tagName === "SELECT") for (const option of field.options) option.defaultSelected = option.value === value;
  else if (field.type === "hidden") field.dataset.served = value;
  else field.defaultValue = value;
}

function keep(form) {
  const found = changes(form);
  if (Object.keys(found).length) sessionStorage.setItem(placeOf(form), JSON.stringify(found));
  else sessionStorage.removeItem(placeOf(form));
}

function put(field, value) {
  if (field.type === "checkbox" || field.type === "radio") field.checked = value;
  else field.value = value;
}

// A field whose stored value has changed meanwhile keeps the new one: what was typed belonged to the old.
function bringBack(form) {
  const stored = JSON.parse(sessionStorage.getItem(placeOf(form)) ?? "{}");
  const back = [...form.elements].filter((field) => kept(field) && !isSecret(field) && stored[nameOf(field)]?.from === servedAt(field));
  for (const field of back) put(field, stored[nameOf(field)].to);
  return { typed: back.length > 0, secret: Boolean(stored[SECRET_TYPED]) };
}

function tell(form, { typed, secret }) {
  const note = document.createElement("div");
  note.className = "kept-note";
  note.setAttribute("role", "status");
  const words = document.createElement("span");
  words.textContent = [
    typed && _("The page was reloaded. Your entries are restored but not saved yet."),
    secret && _("Passwords and other secrets are not kept: enter them again. Nothing is saved yet."),
  ].filter(Boolean).join(" ");
  const key = document.createElement("button");
  key.type = "button";
  key.className = "key";
  key.textContent = _("Discard it");
  key.addEventListener("click", () => {
    sessionStorage.removeItem(placeOf(form));
    loadAgain();
  });
  note.append(words, key);
  form.prepend(note);
}

const watched = new WeakSet();
const stored = new Map(); // by form, what was stored when it was last served or saved; what a preview brings back is only typed

function watch(form) {
  if (watched.has(form)) return;
  watched.add(form);
  for (const field of form.elements) if (field.type === "hidden") field.dataset.served = field.value;
  if (!stored.has(placeOf(form))) stored.set(placeOf(form), storedIn(form));
  const back = bringBack(form);
  if (!back.typed && !back.secret) return;
  form.closest("details")?.setAttribute("open", "");
  tell(form, back);
  if (back.typed) form.dispatchEvent(new Event("input", { bubbles: true }));
}

const watchAll = () => document.querySelectorAll(WORTH_IT).forEach(watch);

// A refusal, and the pages on which somebody is asked for a name or a password first, keep what was typed.
function forgetSent() {
  const place = sessionStorage.getItem(SENT);
  sessionStorage.removeItem(SENT);
  const refused = document.querySelector("[data-problem], .summary-error, main .outcome-refused, .field-error, .sign-in[action='/prove'], .sign-in[action='/login']");
  if (place && !refused) sessionStorage.removeItem(place);
}

const saved = new WeakSet();

function answered({ detail }) {
  const { sourceElement, response, request, hx, text } = detail?.ctx ?? {};
  const form = sourceElement?.closest?.("form");
  if (!form?.matches(WORTH_IT) || !response || (response.status ?? 500) >= 400 || ASKS_FIRST.test(hx?.redirect)) return;
  if (text?.includes("data-question")) return;
  if (new URL(request.action, location).pathname !== new URL(form.action).pathname) return;
  const place = placeOf(form);
  sessionStorage.removeItem(place);
  if (hx?.redirect && new URL(hx.redirect, location).pathname === location.pathname) tellAfterReload(place, stored.get(place) ?? {});
  else if (hx?.retarget) stored.delete(place);
  else saved.add(form);
}

// What the page has now, asked again: a number may be stored in another way than it was typed.
async function storedNow(form) {
  try {
    const answer = await fetch(location.href);
    const page = new DOMParser().parseFromString(await answer.text(), "text/html");
    const there = page.getElementById(form.id);
    return there ? storedIn(there) : null;
  } catch {
    return null;
  }
}

// The answer of a form that stays says below its key that it is saved.
async function swapped({ detail }) {
  const form = detail?.ctx?.sourceElement?.closest?.("form");
  if (!form?.isConnected || !saved.has(form) || !form.querySelector(".outcome .outcome-ok")) return;
  saved.delete(form);
  const before = stored.get(placeOf(form)) ?? {};
  for (const field of form.elements) if (kept(field) && !isSecret(field)) settle(field, nowOf(field));
  const now = await storedNow(form) ?? heldIn(form, nowOf);
  stored.set(placeOf(form), now);
  tellSaved(form, linesOf(before, now));
}

export function start() {
  forgetSent();
  watchAll();
  startSaying((place) => stored.get(place));
  document.addEventListener("htmx:after:swap", watchAll);
  for (const kind of ["input", "change"]) {
    document.addEventListener(kind, (event) => {
      const form = event.target.closest?.(WORTH_IT);
      if (form) keep(form);
    });
  }
  document.addEventListener("htmx:after:request", answered);
  document.addEventListener("htmx:after:swap", swapped);
  // A form that goes as a page: what was typed is forgotten once the page that comes back refuses nothing.
  document.addEventListener("submit", ({ target }) => {
    if (target.matches(WORTH_IT) && !target.hasAttribute("hx-post")) sessionStorage.setItem(SENT, placeOf(target));
  });
}
