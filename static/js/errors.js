// An error reply stands beside what asked for it, never in its place: one rule for every form, key, and part of a page.
// Only a reply that brings a part of the page anew, such as a form with what is wrong in it, takes the place of that part.

import { _ } from "./i18n.js";
import { hasLeft } from "./orders.js";

const OUTCOME = ".outcome, [role=status]";
const WHOLE = /<html\b|<!doctype\b/i;
const toldBeside = new WeakMap();

function make(source) {
  const outcome = document.createElement("div");
  outcome.className = "outcome";
  outcome.role = "status";
  if (source.matches("button")) source.after(outcome);
  else source.append(outcome);
  return outcome;
}

// Where it is said what came of a request.
function outcomeOf({ sourceElement, target }) {
  if (target?.matches?.(OUTCOME)) return target;
  const form = sourceElement.closest("form");
  if (form) return form.querySelector(".outcome") ?? make(form);
  return sourceElement.querySelector(":scope > .outcome, :scope > [role=status]") ?? make(sourceElement);
}

function refusal(...content) {
  const told = document.createElement("div");
  const title = document.createElement("b");
  told.className = "outcome-refused";
  title.textContent = _("Not done.");
  told.append(title, ...content);
  return told;
}

function sentence(text) {
  const line = document.createElement("p");
  line.textContent = text;
  return line;
}

function detailOf(text) {
  try {
    const { detail, title } = JSON.parse(text);
    return detail ?? title;
  } catch {
    return undefined;
  }
}

// What is said of an error reply: a fragment as it is; of a page, a problem document, or a proxy's words one sentence.
function toldBy({ response: { status }, text }, page) {
  if (status === 413) {
    return [refusal(sentence(_("A request to Heliopanel can have at most one megabyte; an upload of a weather file or a photo can have eight.")))];
  }
  const problem = page.querySelectorAll("[data-problem] > :is(.reasons, .lead)");
  if (problem.length) return [refusal(...problem)];
  const detail = detailOf(text);
  if (detail) return [refusal(sentence(detail))];
  if (page.body.children.length && !WHOLE.test(text)) return [...page.body.childNodes];
  return [refusal(sentence(_("The answer was error {status}. Try again in a moment.", { status })))];
}

const renewedBy = (page) => [...page.body.children].find(({ id }) => id && document.getElementById(id));

// What a script asks by itself says nothing.
const byScript = ({ sourceElement }) => sourceElement === document.body;

function place(event) {
  const { ctx } = event.detail;
  if (ctx.response.status < 400) {
    toldBeside.get(ctx.sourceElement)?.replaceChildren();
    return;
  }
  window.htmx.config.noSwap = [204, 304]; // by itself, htmx puts no error anywhere
  if (ctx.hx.retarget) return;
  if (byScript(ctx)) {
    ctx.hx.reswap = "none";
    return;
  }
  const page = new DOMParser().parseFromString(ctx.text, "text/html");
  const renewed = WHOLE.test(ctx.text) ? null : renewedBy(page);
  ctx.select = null;
  if (renewed) {
    Object.assign(ctx.hx, { retarget: `#${CSS.escape(renewed.id)}`, reswap: "outerHTML" });
    return;
  }
  const outcome = outcomeOf(ctx);
  toldBeside.set(ctx.sourceElement, outcome);
  ctx.text = toldBy(ctx, page).map((node) => node.outerHTML ?? node.textContent).join("");
  Object.assign(ctx.hx, { retarget: outcome, reswap: "innerHTML" });
}

// Says that no answer came: none was made, it broke off, or it took too long. What asks again by itself says nothing.
function tellSilence(event) {
  const { ctx } = event.detail;
  const { sourceElement: source, request, status } = ctx;
  const isSilent = ctx.text === undefined && /^error: (?!AbortError)/.test(status);
  if (!isSilent || !source.isConnected || hasLeft(ctx) || byScript(ctx)) return;
  if (/\bevery\b/.test(source.getAttribute("hx-trigger"))) return;
  const outcome = outcomeOf(ctx);
  const told = sentence(request.method?.toUpperCase() === "POST"
    ? _("No answer was received; the command may or may not have been executed. Check the live values, then try again.")
    : _("No answer was received. Try again."));
  told.className = "outcome-refused";
  toldBeside.set(source, outcome);
  outcome.replaceChildren(told);
}

export function start() {
  document.addEventListener("htmx:after:request", place);
  document.addEventListener("htmx:finally:request", tellSilence);
}
