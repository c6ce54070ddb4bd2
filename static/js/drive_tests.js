// Keeps the proofs true: asks for them again when a move or a test has ended, or an answer was taken.

import { facts } from "./facts.js";
import { live } from "./live.js";

let known = null;

function ask() {
  window.htmx.ajax("GET", location.pathname, { target: "#proofs", swap: "outerHTML" });
}

function look() {
  const { tracker } = live;
  if (!tracker) return;
  const now = JSON.stringify([facts.activities.under_test.includes(tracker.activity), tracker.homed, tracker.fault?.code]);
  const changed = known !== null && now !== known;
  known = now;
  if (changed) ask();
}

let asked = document.querySelector("#proofs .ask") !== null;

// A question that has just come up is brought where it is seen.
function bring() {
  const question = document.querySelector("#proofs .ask");
  if (question && !asked) question.scrollIntoView({ block: "center" });
  asked = question !== null;
}

document.addEventListener("htmx:after:swap", bring);
live.on("state", look);
document.addEventListener("htmx:after:request", (event) => {
  const { request, response } = event.detail?.ctx ?? {};
  if (request?.method?.toUpperCase() === "POST" && response?.status < 400) ask();
});
