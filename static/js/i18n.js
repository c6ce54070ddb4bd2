// The texts of the scripts in the language of the page, and how it writes numbers, dates and the compass.

const ENGLISH = { point: ".", date: "%Y-%m-%d", texts: {},
  compass: ["N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW"] };
const told = document.getElementById("texts");

export const spoken = told ? JSON.parse(told.textContent) : ENGLISH;

// Returns a text with its gaps filled: `_("{n} of {all} heartbeats lost", { n, all })`.
export function _(text, values = {}) {
  return (spoken.texts[text] ?? text).replace(/\{(\w+)\}/g, (gap, name) => values[name] ?? gap);
}
