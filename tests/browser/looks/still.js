() => {
  const found = document.getAnimations().map((one) => `moves: ${one.effect.target.outerHTML.slice(0, 80)}`);
  for (const e of [document.documentElement, ...document.querySelectorAll('body, body *')]) {
    for (const part of ['', '::before', '::after']) {
      const style = getComputedStyle(e, part || null);
      const lasts = (text) => text.split(',').some((one) => parseFloat(one) > 0);
      if (style.animationName !== 'none' && lasts(style.animationDuration)) found.push(`animation: ${e.className}${part}`);
      if (lasts(style.transitionDuration)) found.push(`transition: ${e.className}${part}`);
      if (style.scrollBehavior !== 'auto') found.push(`scrolls smoothly: ${e.className}`);
    }
  }
  return [...new Set(found)];
}
