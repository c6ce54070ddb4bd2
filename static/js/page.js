// What every page runs.

import { start as startControl } from "./control.js";
import { start as startAlarms } from "./alarms.js";
import { start as startAsking } from "./asked.js";
import { start as startErrors } from "./errors.js";
import "./hold.js";
import { start as startLive } from "./live.js";
import { start as startMessages } from "./messages.js";
import { start as startOrders } from "./orders.js";
import { start as startOutdated } from "./outdated.js";
import { start as startProving } from "./prove.js";
import { start as startSlots } from "./slots.js";
import { start as startSteps } from "./steps.js";
import { start as startStop } from "./stop.js";
import { start as startTheme } from "./theme.js";
import { start as stayAwake } from "./wake.js";

startStop();
startTheme();
startOrders();
startErrors();
startAsking();
startProving();
startSlots();
startSteps();
startControl();
startAlarms();
startMessages();
startOutdated();
startLive();
stayAwake();

// Pages on which nothing is typed do not load what keeps it; the page says while it is still under way.
const { dataset } = document.documentElement;
let keeping = null;
function keepTyped() {
  if (keeping || !(document.querySelector("main form[method=post]:not(.action)") || sessionStorage.length)) return;
  dataset.keeping = "loading";
  keeping = import("./drafts.js").then(({ start }) => start()).finally(() => delete dataset.keeping);
}
document.addEventListener("htmx:after:swap", keepTyped);
keepTyped();

// The rail of a page of the whole site leads to the tracker that was looked at last.
if (dataset.tracker) document.cookie = `tracker=${encodeURIComponent(dataset.tracker)}; path=/; samesite=lax`;

// What opens over the page is closed by whoever leaves it, and by Escape.
for (const list of document.querySelectorAll("details.pop")) {
  const whole = list.closest(".messages") ?? list;
  whole.addEventListener("focusout", ({ relatedTarget }) => { if (relatedTarget && !whole.contains(relatedTarget)) list.open = false; });
  addEventListener("pointerdown", ({ target }) => { if (!whole.contains(target)) list.open = false; });
  list.addEventListener("keydown", ({ key }) => {
    if (key !== "Escape") return;
    list.open = false;
    list.querySelector("summary").focus();
  });
}

const heading = document.getElementById("heading");
if (document.getElementById("steps") && heading && !document.querySelector("[data-focus]")) heading.focus();
