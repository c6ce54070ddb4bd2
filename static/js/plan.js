// The plan of a show: what was worked out for other values than those typed now cannot be started.

import { _ } from "./i18n.js";

const form = document.getElementById("plan-form");

const verdict = () => document.getElementById("verdict");

let changed = false;

function outdate() {
  verdict().inert = true;
  verdict().setAttribute("aria-busy", "true");
}

form.addEventListener("input", () => {
  changed = true;
  outdate();
  document.querySelector(".plan-days [aria-current]")?.removeAttribute("aria-current");
});
document.addEventListener("htmx:before:request", (event) => {
  if (event.detail?.ctx?.sourceElement === form) changed = false;
});
// Whoever presses Check is shown the answer, which on a phone stands above the form.
let asked = false;
form.addEventListener("submit", () => { asked = true; });
document.addEventListener("htmx:after:swap", () => {
  if (!asked) return;
  asked = false;
  const box = verdict().getBoundingClientRect();
  if (box.top < 0 || box.top > innerHeight / 2) verdict().scrollIntoView();
});
// An answer that comes after more was typed is already out of date.
document.addEventListener("htmx:after:swap", () => { if (changed) outdate(); });
document.addEventListener("htmx:finally:request", (event) => {
  if (event.detail?.ctx?.sourceElement !== form || changed || event.detail.ctx.response?.status) return;
  verdict().querySelector("h2").textContent = _("No answer: press Check when the connection is back.");
});
