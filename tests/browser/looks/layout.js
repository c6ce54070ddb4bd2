(limits) => {
  const found = [];
  const tell = (what, ...which) => found.push(`${what}: ${which.map(name).join(" | ")}`);
  const name = (e) => {
    if (typeof e === "string" || typeof e === "number") return e;
    const text = (e.value && e.tagName === "BUTTON" ? "" : e.textContent).trim().replace(/\s+/g, " ").slice(0, 50);
    return `${e.tagName.toLowerCase()}${e.id ? `#${e.id}` : ""}.${String(e.className.baseVal ?? e.className)} "${text}"`;
  };
  const forReaders = (e) => {
    for (let up = e; up; up = up.parentElement) if (getComputedStyle(up).clipPath === "inset(50%)") return true;
    return false;
  };
  const shown = (e) => e.checkVisibility({ visibilityProperty: true }) && !e.closest(".skip, .visually-hidden") && !forReaders(e);
  const scroller = (e) => {
    for (let up = e.parentElement; up && up !== document.body; up = up.parentElement) {
      if (/auto|scroll/.test(getComputedStyle(up).overflowX)) return up;
    }
    return null;
  };
  const shortened = (e) => {
    for (let up = e; up && up !== document.body; up = up.parentElement) if (getComputedStyle(up).webkitLineClamp !== "none") return up;
    return null;
  };
  // What of a box can be seen within the part that scrolls it, or that shows its first lines.
  const seen = (box, e) => {
    const part = (scroller(e) ?? shortened(e))?.getBoundingClientRect();
    if (!part) return box;
    return { left: Math.max(box.left, part.left), right: Math.min(box.right, part.right),
      top: Math.max(box.top, part.top), bottom: Math.min(box.bottom, part.bottom) };
  };
  const across = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left);
  const down = (a, b) => Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
  // What stays in sight lies over the page when it is scrolled; what is opened over it lies over the rest.
  const layer = (e) => {
    const laid = e.closest(".question, .note, .jog-now, .outcome-refused, .outcome-ok");
    const lies = laid && /fixed|absolute/.test(getComputedStyle(laid).position) ? laid : null;
    const over = lies ?? e.closest(".pop[open] > :not(summary), .messages:has(> [open]), :popover-open, dialog[open], .stop-answer, .prove-here");
    if (over) return `opened ${[...document.querySelectorAll("*")].indexOf(over)}`;
    return e.closest(".header, .rail, .footer") && scrollY > 0 ? "frame" : e.closest(".footer") && innerWidth < 900 ? "below" : "page";
  };

  const beside = document.documentElement.scrollWidth - innerWidth;
  if (beside > 0) tell("beside the screen", `${beside} px`);

  // Targets: large enough, not on one another, apart.
  const inSentence = (e) => {
    if (e.tagName !== "A" || getComputedStyle(e).display !== "inline") return false;
    let block = e.parentElement;
    while (getComputedStyle(block).display === "inline") block = block.parentElement;
    return block.textContent.trim() !== e.textContent.trim();
  };
  const kinds = "a[href], button, input:not([type=hidden]), select, textarea, summary, [role=button], [role=slider]";
  const touched = [...document.querySelectorAll(kinds)].filter((e) => shown(e) && !inSentence(e));
  const whole = [...new Set(touched.map((e) => (e.matches(".glance-open") ? e.closest(".glance") : e.closest("label") ?? e)))];
  const targets = whole.map((e) => ({ e, box: seen(e.getBoundingClientRect(), e), full: e.getBoundingClientRect() }));
  for (const { e, full } of targets) {
    const least = e.matches("[data-jog]") ? limits.held : limits.target;
    if (full.width < least - 0.5 || full.height < least - 0.5) {
      tell("too small", e, `${full.width.toFixed(0)}x${full.height.toFixed(0)}`);
    }
  }
  const framed = (e) => e.matches(".key, .input, .stop-key, [role=slider]");
  const oneChoice = (a, b) => a.closest(".segments") && a.closest(".segments") === b.closest(".segments");
  targets.forEach(({ e: a, box: one }, index) => targets.slice(index + 1).forEach(({ e: b, box: two }) => {
    if (a.contains(b) || b.contains(a) || layer(a) !== layer(b)) return;
    const wide = across(one, two), high = down(one, two);
    const onCard = [a, b].some((e) => e.matches(".glance"));
    if (wide > 1 && high > 1 && !oneChoice(a, b) && !onCard) tell("overlap", a, b, `${wide.toFixed(0)}x${high.toFixed(0)}`);
    const least = a.matches("[data-jog]") && b.matches("[data-jog]") ? limits.heldGap : limits.gap;
    const near = Math.max(-wide, -high);
    if (framed(a) && framed(b) && !oneChoice(a, b) && near >= 0 && near < least - 0.5 && Math.max(wide, high) > 0) {
      tell("too near", a, b, `${near.toFixed(0)} px`);
    }
  }));

  // Words: none wider than what holds them, none cut off, none on other words.
  const holders = [...document.querySelectorAll("body *:not(script):not(style):not(option)")].filter((e) =>
    !e.closest("svg") && [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) && shown(e));
  for (const e of holders) {
    const style = getComputedStyle(e);
    if (style.display === "inline" || e.tagName === "TEXTAREA") continue;
    if (style.textOverflow === "ellipsis" || style.webkitLineClamp !== "none") continue;
    const scrolls = /auto|scroll/.test(style.overflowX);
    if (!scrolls && e.scrollWidth > e.clientWidth + 1) tell("too wide", e, `${e.scrollWidth} of ${e.clientWidth}`);
    if (style.overflowY === "hidden" && e.scrollHeight > e.clientHeight + 2) tell("cut off", e);
  }
  const words = [];
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const e = node.parentElement;
    if (!node.data.trim() || e.closest("script, style, option, svg, .u-legend, canvas") || !shown(e)) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    let block = e;
    while (getComputedStyle(block).display === "inline") block = block.parentElement;
    for (const rect of range.getClientRects()) {
      if (rect.width < 1) continue;
      let box = seen(rect, e);
      const ends = getComputedStyle(block).textOverflow === "ellipsis";
      if (ends) {
        const { left, right } = block.getBoundingClientRect();
        box = { left: Math.max(box.left, left), right: Math.min(box.right, right), top: box.top, bottom: box.bottom };
      }
      const hides = e.closest("[style*=overflow]") || ends;
      if (!scroller(e) && !hides && (rect.left < -1 || rect.right > innerWidth + 1)) tell("beside the screen", e);
      const panel = e.closest(".panel")?.getBoundingClientRect();
      if (panel && !hides && (box.left < panel.left - 1 || box.right > panel.right + 1)) tell("beside its panel", e);
      if (box.right > box.left && box.bottom > box.top) words.push({ e, block, box });
    }
  }
  words.forEach((one, index) => {
    for (const two of words.slice(index + 1)) {
      const high = down(one.box, two.box);
      if (high <= 0 || across(one.box, two.box) <= 2) continue;
      const least = Math.min(one.box.bottom - one.box.top, two.box.bottom - two.box.top);
      if (high < 0.4 * least || one.block === two.block || layer(one.e) !== layer(two.e)) continue;
      if (one.block.contains(two.block) || two.block.contains(one.block)) continue;
      tell("words on words", one.e, two.e);
    }
  });

  // Pictures: what is written in them is neither cut off at their edge nor written over.
  for (const svg of document.querySelectorAll("svg")) {
    const texts = [...svg.querySelectorAll("text")].filter((e) => e.textContent.trim() && e.checkVisibility());
    if (!texts.length || !shown(svg)) continue;
    const frame = svg.getBoundingClientRect();
    const boxes = texts.map((e) => e.getBoundingClientRect());
    boxes.forEach((box, index) => {
      const over = Math.max(frame.left - box.left, box.right - frame.right, frame.top - box.top, box.bottom - frame.bottom);
      if (over > 3 && over > 0.3 * box.height) tell("cut off in a picture", texts[index], `${over.toFixed(0)} px`);
      boxes.slice(index + 1).forEach((other, next) => {
        const least = Math.min(box.height, other.height);
        if (across(box, other) > 4 && down(box, other) > 0.5 * least) {
          tell("words on words in a picture", texts[index], texts[index + 1 + next]);
        }
      });
    });
  }
  return [...new Set(found)];
}
