// The password again, on the page that asks for it: nothing that was typed is left, and what was asked is asked again.

import { _ } from "./i18n.js";

const PAGE = "/prove";
let asked = null;

const isNeeded = (ctx) => ctx.hx?.redirect?.startsWith(PAGE) || ctx.response?.headers?.get("Proof-Needed") !== null;

function panel() {
  const form = document.createElement("form");
  form.className = "banner prove-here";
  form.id = "prove-here";
  form.setAttribute("aria-label", _("Confirm your password"));
  form.innerHTML = '<label for="prove-password"></label><input class="input" id="prove-password" type="password" autocomplete="current-password" required>'
    + '<button class="key key-primary"></button><button class="key" type="button"></button><p role="alert"></p>';
  const [go, cancel] = form.querySelectorAll("button");
  form.querySelector("label").textContent = _("Confirm your password. Your entries are kept.");
  go.textContent = _("Continue");
  cancel.textContent = _("Cancel");
  cancel.addEventListener("click", close);
  form.addEventListener("submit", (event) => { event.preventDefault(); prove(form); });
  document.querySelector(".footer").prepend(form);
  return form;
}

function close() {
  document.getElementById("prove-here")?.remove();
  asked = null;
}

function open(form, submitter) {
  close();
  asked = { form, submitter };
  panel().querySelector("input").focus();
}

async function prove(form) {
  const body = new URLSearchParams({ password: form.querySelector("input").value, back: "/" });
  const headers = { "X-CSRF-Token": document.documentElement.dataset.csrf ?? "" };
  const words = form.querySelector("p");
  try {
    const answer = await fetch(PAGE, { method: "POST", body, headers, redirect: "manual" });
    if (answer.type !== "opaqueredirect" && !answer.ok) {
      words.textContent = answer.status === 429 ? _("Too many attempts: wait a minute, then try again.") : _("The password is wrong.");
      return;
    }
  } catch {
    words.textContent = _("No answer was received. Try again.");
    return;
  }
  const again = asked;
  close();
  again.form.requestSubmit(again.submitter?.form === again.form ? again.submitter : null);
}

export function start() {
  document.addEventListener("htmx:before:response", (event) => {
    const { ctx } = event.detail;
    const form = ctx.sourceElement?.closest("form");
    if (!form || ctx.request.method?.toUpperCase() !== "POST" || !isNeeded(ctx)) return;
    event.preventDefault();
    delete ctx.hx.redirect;
    open(form, ctx.request.submitter ?? ctx.submitter ?? (ctx.sourceElement.matches("button") ? ctx.sourceElement : null));
  });
}
