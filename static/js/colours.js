// The looks of the present theme, read once and again after a change of theme; a worker is told them.

const NAMES = ["blue", "cell", "cell-line", "ground", "hair", "key-border", "line", "metal", "outline", "panel", "second", "shade", "sun-disc",
  "sunken", "text"];
const known = new Map();

export function colour(name) {
  if (!known.has(name)) known.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return known.get(name);
}

export function font() {
  if (!known.has(font)) known.set(font, getComputedStyle(document.body).fontFamily);
  return known.get(font);
}

// What a worker needs of it, which has no document to read it from.
export const looks = () => ({ colours: NAMES.map((name) => [name, colour(name)]), letters: font() });

export function takeLooks({ colours, letters }) {
  for (const [name, value] of [...colours, [font, letters]]) known.set(name, value);
}

addEventListener("theme", () => known.clear());
