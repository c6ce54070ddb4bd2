() => {
  const found = [];
  const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && !e.closest('.skip, .visually-hidden');
  const bare = (e) => {
    const style = getComputedStyle(e);
    const edge = ['Top', 'Right', 'Bottom', 'Left'].some((side) =>
      style[`border${side}Style`] !== 'none' && parseFloat(style[`border${side}Width`]) >= 1
      && style[`border${side}Color`] !== style.backgroundColor);
    return !edge;
  };
  for (const e of document.querySelectorAll('.key, .input, .stop-key')) {
    if (shown(e) && bare(e)) found.push(`no edge: ${e.className} ${e.textContent.trim().slice(0, 40)}`);
  }
  const same = (one, two) => ['backgroundColor', 'borderTopColor', 'borderBottomColor', 'color', 'textDecorationLine']
    .every((name) => getComputedStyle(one)[name] === getComputedStyle(two)[name]);
  const groups = [['.rail-pages', 'a', '[aria-current]'], ['.segments', '.key', ':has(:checked), [aria-pressed="true"]']];
  for (const [group, part, chosen] of groups) {
    for (const one of [...document.querySelectorAll(group)].filter(shown)) {
      const parts = [...one.querySelectorAll(part)];
      const is = parts.filter((e) => e.matches(chosen.split(', ').map((rule) => `${part}${rule}`).join(', ')));
      const other = parts.find((e) => !is.includes(e));
      if (is.length && other && same(is[0], other)) found.push(`looks like the others: ${is[0].textContent.trim()}`);
    }
  }
  const seeThrough = (ink) => /, 0\)$/.test(ink) && ink.startsWith('rgba');
  const groundOf = (e) => {
    const ground = getComputedStyle(e).backgroundColor;
    return seeThrough(ground) && e.parentElement ? groundOf(e.parentElement) : ground;
  };
  for (const svg of [...document.querySelectorAll('main svg, header svg, .rail svg')].filter(shown)) {
    const inks = [...svg.querySelectorAll('*')].filter((e) => e.getBBox && e.checkVisibility()).flatMap((e) => {
      const style = getComputedStyle(e);
      return [style.fill, style.stroke];
    }).filter((ink) => ink !== 'none' && !seeThrough(ink));
    const ground = groundOf(svg);
    if (inks.length && inks.every((ink) => ink === ground)) found.push(`vanishes: ${svg.outerHTML.slice(0, 90)}`);
  }
  return [...new Set(found)];
}
