// What was typed outlives a reload, in this tab: it comes back with a word about it, until it is saved or discarded.
// Secrets are never stored: of these only that they were typed, so that the page can say that they are gone.

import { loadAgain } from "./reload.js";
import { _ } from "./i18n.js";
import { linesOf, start as startSaying, tell as tellSaved, tellAfterReload } from "./saved.js";

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

function standsAt(field) {
  if (field.type === "checkbox" || field.type === "radio") return field.defaultChecked;
  if (field.tagName === "SELECT") return [...field.options].find((one) => one.defaultSelected)?.value ?? field.options[0]?.value ?? "";
  return field.type === "hidden" ? field.dataset.served ?? "" : field.defaultValue;
}

const nowOf = (field) => (field.type === "checkbox" || field.type === "radio" ? field.checked : field.value);
const nameOf = (field) => (field.type === "radio" ? `${field.name}=${field.value}` : field.name);

const changed = (form) => [...form.elements].filter((field) => kept(field) && nowOf(field) !== standsAt(field))
  .map((field) => [field, { from: standsAt(field), to: nowOf(field), secret: isSecret(field) }]);

function changes(form) {
  const found = {};
  for (const [field, { from, to, secret }] of changed(form)) {
    if (secret) found[SECRET_TYPED] = true;
    else found[nameOf(field)] = { from, to };
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
  const back = [...form.elements].filter((field) => kept(field) && !isSecret(field) && stored[nameOf(field)]?.from === standsAt(field));
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

function watch(form) {
  if (watched.has(form)) return;
  watched.add(form);
  for (const field of form.elements) if (field.type === "hidden") field.dataset.served = field.value;
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

const sent = new WeakMap();

function remember({ detail: { ctx } }) {
  const form = ctx.sourceElement?.closest?.("form");
  if (form?.matches(WORTH_IT)) sent.set(form, changed(form));
}

function answered({ detail }) {
  const { sourceElement, response, request, hx, text } = detail?.ctx ?? {};
  const form = sourceElement?.closest?.("form");
  if (!form || !response || (response.status ?? 500) >= 400 || ASKS_FIRST.test(hx?.redirect)) return;
  if (text?.includes("data-question")) return;
  if (new URL(request.action, location).pathname !== new URL(form.action).pathname) return;
  sessionStorage.removeItem(placeOf(form));
  if (hx?.redirect && new URL(hx.redirect, location).pathname === location.pathname) tellAfterReload(linesOf(form, sent.get(form) ?? []));
}

// The answer of a form that stays says below its key that it is saved.
function swapped({ detail }) {
  const form = detail?.ctx?.sourceElement?.closest?.("form");
  if (!form?.isConnected || !sent.has(form) || !form.querySelector(".outcome .outcome-ok")) return;
  const saved = sent.get(form);
  tellSaved(form, linesOf(form, saved));
  for (const [field, { to, secret }] of saved) if (!secret) settle(field, to);
  sent.delete(form);
}

export function start() {
  forgetSent();
  startSaying();
  watchAll();
  document.addEventListener("htmx:after:swap", watchAll);
  for (const kind of ["input", "change"]) {
    document.addEventListener(kind, (event) => {
      const form = event.target.closest?.(WORTH_IT);
      if (form) keep(form);
    });
  }
  document.addEventListener("htmx:config:request", remember);
  document.addEventListener("htmx:after:request", answered);
  document.addEventListener("htmx:after:swap", swapped);
  // A form that goes as a page: what was typed is forgotten once the page that comes back refuses nothing.
  document.addEventListener("submit", ({ target }) => {
    if (target.matches(WORTH_IT) && !target.hasAttribute("hx-post")) sessionStorage.setItem(SENT, placeOf(target));
  });
}
