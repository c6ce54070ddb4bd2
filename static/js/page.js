// What every page runs.

import { start as startControl } from "./control.js";
import { start as startAlarms } from "./alarms.js";
import { start as startAsking } from "./asked.js";
import { start as startLive } from "./live.js";
import { start as startOrders } from "./orders.js";
import { start as startOutdated } from "./outdated.js";
import { start as startProving } from "./prove.js";
import { start as startSteps } from "./steps.js";
import { start as startStop } from "./stop.js";
import { start as startTheme } from "./theme.js";
import { start as stayAwake } from "./wake.js";

startStop();
startTheme();
startOrders();
startAsking();
startProving();
startSteps();
startControl();
startAlarms();
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

// On a narrow screen the tabs are one row that scrolls: the page's own stands in sight.
const tab = document.querySelector(".tabs a[aria-current]");
if (tab) tab.closest("ul").scrollLeft = tab.offsetLeft - (innerWidth - tab.offsetWidth) / 2;

// The list of languages lies on the page: it is closed by whoever leaves it, and by Escape.
const list = document.querySelector(".language");
list.addEventListener("focusout", ({ relatedTarget }) => { if (relatedTarget && !list.contains(relatedTarget)) list.open = false; });
list.addEventListener("keydown", ({ key }) => {
  if (key !== "Escape") return;
  list.open = false;
  list.querySelector("summary").focus();
});

const heading = document.getElementById("heading");
if (document.getElementById("steps") && heading && !document.querySelector("[data-focus]")) heading.focus();
