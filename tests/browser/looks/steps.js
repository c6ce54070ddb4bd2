// What does not fit on one of the five steps as it is met: a tablet that scrolls, a button that a phone does not show, many words.
(most) => {
  if (!document.getElementById("steps") || document.querySelector(".help[open], :popover-open")) return [];
  const found = [];
  const forReaders = (e) => {
    for (let up = e; up; up = up.parentElement) if (getComputedStyle(up).clipPath === "inset(50%)") return true;
    return false;
  };
  const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && !forReaders(e);
  if (innerWidth >= 900) {
    const beyond = document.documentElement.scrollHeight - innerHeight;
    if (beyond > 0) found.push(`the step scrolls by ${beyond} px`);
  } else {
    const row = [...document.querySelectorAll(".slots .key, .footer")].filter(shown).map((e) => e.getBoundingClientRect().top);
    const end = Math.min(...row);
    // What lies over the keys of a page is put aside by its own keys: nothing else covers them.
    const keys = [...document.querySelectorAll(".content :is(a.key, button, .key-choice, .input)")].filter(shown);
    for (const key of keys) {
      const { bottom } = key.getBoundingClientRect();
      const what = (key.textContent || key.name).trim();
      if (bottom > end + 0.5) found.push(`below the fold by ${(bottom - end).toFixed(0)} px: ${what}`);
      const box = key.getBoundingClientRect();
      const over = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
      if (over && !key.contains(over) && !over.contains(key) && !over.closest(".question, .note")) found.push(`covered: ${what}`);
    }
  }
  const words = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const e = node.parentElement;
    if (!e.closest(".content, .slots, #steps > .question") || e.closest("script, style, option, svg, template, summary") || !shown(e)) continue;
    words.push(...(node.data.match(/[\p{L}\p{N}]*\p{L}[\p{L}\p{N}]+/gu) ?? []));
  }
  const isWrong = document.querySelector(".field-error");
  if (document.documentElement.lang.startsWith("en") && !isWrong && words.length > most) found.push(`${words.length} words: ${words.join(" ")}`);
  return found;
}
