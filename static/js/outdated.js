// A page of another build, or from before the controller's last start: it says so and is loaded again in place.

import { loadAgain } from "./reload.js";
import { live } from "./live.js";

const SHOW_MS = 1500;
const LOOP_MS = 5000;
const LAST = "loaded-again-at";
const banner = document.getElementById("outdated-banner");
const mark = document.documentElement.dataset.page ?? "";
let touched = false;
let told = false;

// Whoever has typed something loads the page when it suits; a page that has just been loaded again waits, too.
function tell({ ordered }) {
  if (told && !ordered) return;
  told = true;
  banner.hidden = false;
  const since = Date.now() - Number(sessionStorage.getItem(LAST) ?? 0);
  const justLoaded = since >= 0 && since < LOOP_MS;
  if ((ordered || !touched) && !justLoaded) setTimeout(again, SHOW_MS);
}

function again() {
  sessionStorage.setItem(LAST, Date.now());
  loadAgain();
}

function heard() {
  const [build, life] = mark.split(".");
  const changed = live.build !== null && live.build !== build;
  const restarted = life && live.site && live.site.boot_id !== life;
  if (changed || restarted) tell({ ordered: false });
}

export function start() {
  addEventListener("input", () => { touched = true; });
  document.addEventListener("htmx:after:request", (event) => {
    if (event.detail?.ctx?.response?.headers?.get("Page-Outdated")) tell({ ordered: true });
  });
  document.getElementById("outdated-load").addEventListener("click", again);
  live.on("state", heard);
  live.on("jog", (message) => {
    if (message.reasons?.some((reason) => reason.code === "page_outdated")) tell({ ordered: true });
  });
}
