// The colours of the present theme, read once and again after a change of theme.

const known = new Map();

export function colour(name) {
  if (!known.has(name)) known.set(name, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  return known.get(name);
}

addEventListener("theme", () => known.clear());
