// The texts of the scripts in the language of the page; English is what they are written in.

import { facts } from "./facts.js";

const told = document.getElementById("texts");

export const spoken = { point: facts.point, date: facts.date, compass: facts.compass, texts: told ? JSON.parse(told.textContent).texts : {} };

// Returns a text with its gaps filled: `_("{time} ms", { time })`.
export function _(text, values = {}) {
  return (spoken.texts[text] ?? text).replace(/\{(\w+)\}/g, (gap, name) => values[name] ?? gap);
}
