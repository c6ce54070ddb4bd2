// While a day is simulated the page says so, how long it has taken, and what comes then.

import { _ } from "./i18n.js";

const ONE_SECOND_MS = 1000;

let timer = 0;

const isOurs = (event) => event.detail.ctx.sourceElement?.closest("form")?.id === "simulate-form";

function begin(event) {
  if (!isOurs(event)) return;
  const working = document.getElementById("simulate-working");
  const began = performance.now();
  const tell = () => {
    const seconds = Math.floor((performance.now() - began) / ONE_SECOND_MS);
    document.getElementById("simulate-elapsed").textContent = _("{seconds} s so far", { seconds });
  };
  working.hidden = false;
  tell();
  clearInterval(timer);
  timer = setInterval(tell, ONE_SECOND_MS);
  working.scrollIntoView({ block: "nearest", behavior: "instant" });
}

function end(event) {
  if (!isOurs(event)) return;
  clearInterval(timer);
  document.getElementById("simulate-working").hidden = true;
}

document.addEventListener("htmx:config:request", begin);
document.addEventListener("htmx:finally:request", end);
