// Day, sun and night at one tap, without loading the page again; or by the sun's elevation, as it moves.

import { facts } from "./facts.js";
import { live } from "./live.js";

const { choices: CHOICES, glare_above_deg: GLARE_ABOVE_DEG, night_below_deg: NIGHT_BELOW_DEG } = facts.themes;
const root = document.documentElement;

// The same as theme_of in app/web/shell/themes.py.
function themeOf(choice) {
  if (choice !== "auto") return choice;
  const elevation = live.site?.sun?.apparent_elevation_deg;
  if (elevation === undefined || elevation === null) return root.dataset.theme;
  if (elevation < NIGHT_BELOW_DEG) return "night";
  return elevation > GLARE_ABOVE_DEG ? "sun" : "day";
}

function show() {
  const theme = themeOf(root.dataset.choice);
  if (root.dataset.theme === theme) return;
  root.dataset.theme = theme;
  paintBrowser();
  dispatchEvent(new CustomEvent("theme"));
}

function paintBrowser() {
  const colour = getComputedStyle(root).getPropertyValue("--panel").trim();
  document.querySelector('meta[name="theme-color"]')?.setAttribute("content", colour);
}

// Every element is styled and laid out anew, which takes a slow tablet a while: first it shows that the key was heard.
const afterPaint = (work) => requestAnimationFrame(() => setTimeout(work));

export function start() {
  const form = document.getElementById("theme-form");
  form.addEventListener("submit", (event) => {
    const next = CHOICES[(CHOICES.indexOf(root.dataset.choice) + 1) % CHOICES.length];
    event.preventDefault();
    root.dataset.choice = next;
    document.cookie = `theme=${next}; path=/; max-age=${facts.kept_s}; samesite=lax`;
    const [key, words] = [form.querySelector("button"), form.querySelector("button span")];
    for (const icon of key.querySelectorAll("[data-choice-icon]")) {
      icon.hidden = icon.dataset.choiceIcon !== next;
      if (icon.hidden) continue;
      words.textContent = icon.dataset.name;
      key.setAttribute("aria-label", icon.dataset.label);
    }
    afterPaint(show);
  });
  paintBrowser();
  live.on("state", show);
}
