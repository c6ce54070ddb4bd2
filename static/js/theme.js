// Day, sun and night at one tap, without loading the page again.

const THEMES = ["day", "sun", "night"];
const A_YEAR_S = 31536000;

export function start() {
  const form = document.getElementById("theme-form");
  form.addEventListener("submit", (event) => {
    const root = document.documentElement;
    const next = THEMES[(THEMES.indexOf(root.dataset.theme) + 1) % THEMES.length];
    event.preventDefault();
    root.dataset.theme = next;
    document.cookie = `theme=${next}; path=/; max-age=${A_YEAR_S}; samesite=lax`;
    form.querySelector("button span").textContent = next.charAt(0).toUpperCase() + next.slice(1);
    form.querySelector("button").setAttribute("aria-label", `Theme: ${next}. Change to the next of day, sun, night.`);
    dispatchEvent(new CustomEvent("theme"));
  });
}
