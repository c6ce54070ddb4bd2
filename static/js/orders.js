// Forms that send orders: a one-time id for each press, the instant of the press, and no sending while the link is down.

import { live } from "./live.js";
import { _ } from "./i18n.js";

export function randomId() {
  const bytes = crypto.getRandomValues(new Uint8Array(12));
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}

let leftAt = -1;

export const hasLeft = ({ askedAt }) => askedAt <= leftAt;

// Whoever has gone on to another page is not brought back by the answer to an order that was given before.
function stayAway(event) {
  const { ctx } = event.detail;
  if (ctx.hx?.redirect && hasLeft(ctx)) delete ctx.hx.redirect;
}

// On a page of the whole site an order may be about one of its trackers.
const aboutWhich = (form) => live.tracker ?? live.trackerOf(form?.closest("[data-tracker]")?.dataset.tracker);

function prepare(event) {
  const { ctx } = event.detail;
  ctx.askedAt = performance.now();
  const form = ctx.sourceElement.closest("form");
  if (!form || ctx.request.method?.toUpperCase() !== "POST") return;
  if (form.hasAttribute("data-moves") && live.link !== "live") {
    event.preventDefault();
    return;
  }
  if (document.documentElement.dataset.csrf) ctx.request.headers["X-CSRF-Token"] = document.documentElement.dataset.csrf;
  ctx.request.headers["X-Page"] = document.documentElement.dataset.page ?? "";
  const body = ctx.request.body;
  if (body?.has?.("issued_at")) body.set("issued_at", live.machineNow() ?? "");
  if (body?.has?.("key")) body.set("key", randomId());
  if (body?.has?.("epoch")) body.set("epoch", aboutWhich(form)?.control?.epoch ?? "");
}

// After a swap that reports wrong input, the summary of errors has the focus.
function focusSummary() {
  document.querySelector("[data-focus]")?.focus();
}

export function start() {
  document.addEventListener("htmx:config:request", prepare);
  document.addEventListener("htmx:before:response", stayAway);
  addEventListener("beforeunload", () => { leftAt = performance.now(); });
  document.addEventListener("htmx:after:swap", focusSummary);
  focusSummary();
}
