// The plan of a show: what was worked out for other values than those typed now cannot be started.

import { _ } from "./said.js";

const form = document.getElementById("plan-form");

const verdict = () => document.getElementById("verdict");

let changed = false;

function outdate() {
  verdict().inert = true;
  verdict().setAttribute("aria-busy", "true");
}

form.addEventListener("input", () => { changed = true; outdate(); });
document.addEventListener("htmx:before:request", (event) => {
  if (event.detail?.ctx?.sourceElement === form) changed = false;
});
// An answer that comes after more was typed is already out of date.
document.addEventListener("htmx:after:swap", () => { if (changed) outdate(); });
document.addEventListener("htmx:finally:request", (event) => {
  if (event.detail?.ctx?.sourceElement !== form || changed || event.detail.ctx.response?.status) return;
  verdict().querySelector("h2").textContent = _("No answer: press Check when the connection is back.");
});
