() => {
  const found = [];
  const kinds = [['header, [role=banner]', 1], ['main', 1], ['footer, [role=contentinfo]', 1], ['h1', 1]];
  const atTop = (e) => !e.parentElement.closest('article, aside, main, nav, section');
  for (const [kind, count] of kinds) {
    const many = [...document.querySelectorAll(kind)].filter((e) => kind === 'h1' || kind === 'main' || atTop(e)).length;
    if (many !== count) found.push(`${many} of ${kind}`);
  }
  const names = [...document.querySelectorAll('nav')].filter((e) => e.checkVisibility()).map((e) => e.getAttribute('aria-label') ?? '');
  if (names.includes('') || new Set(names).size < names.length) found.push(`navigation without a name of its own: ${names}`);
  const levels = [...document.querySelectorAll('h1, h2, h3, h4, h5, h6')].filter((e) => e.checkVisibility());
  let before = 0;
  for (const e of levels) {
    const level = Number(e.tagName[1]);
    if (level > before + 1) found.push(`heading ${level} after ${before}: ${e.textContent.trim().slice(0, 50)}`);
    before = level;
  }
  const skip = document.querySelector('body > a:first-child');
  const aim = skip && document.querySelector(skip.getAttribute('href'));
  if (!aim || aim.tabIndex !== -1) found.push('no way past the frame');
  for (const e of document.querySelectorAll('[tabindex]')) if (e.tabIndex > 0) found.push(`tabindex ${e.tabIndex}`);
  return found;
}
