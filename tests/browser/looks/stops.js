// Puts down every place where the focus rests, as soon as the page has scrolled to it: before the next key is pressed.
() => {
  const stops = [];
  const named = (e) => {
    if (!e.dataset.stop) e.dataset.stop = String(Math.random());
    return { key: e.dataset.stop, text: e.outerHTML.replace(/ data-stop="[^"]*"/, "").slice(0, 110) };
  };
  const marked = (e) => [e.closest(".key-choice") ?? e, e].flatMap((one) => [getComputedStyle(one), getComputedStyle(one, "::after")])
    .some((style) => style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2);
  const scrolledBy = (e) => {
    let far = scrollY;
    for (let up = e.parentElement; up && up !== document.body; up = up.parentElement) far += up.scrollTop;
    return far;
  };
  const look = () => {
    const e = document.activeElement;
    if (!e || e === document.body) return;
    const box = (e.closest(".key-choice") ?? e).getBoundingClientRect();
    const footer = document.querySelector(".footer");
    const below = footer.getBoundingClientRect();
    const inFrame = e.closest(".header, .rail, .footer, .skip");
    const top = inFrame || below.left > 0 ? innerHeight : below.top;
    const scrolls = e.tagName === "TEXTAREA";  // It shows the line that is written.
    const head = inFrame ? 0 : document.querySelector(".header").getBoundingClientRect().bottom;
    const hidden = box.height <= top - head && !scrolls ? box.bottom > top + 1 || box.top < -1 : box.top >= top;
    const x = Math.min(Math.max((box.left + box.right) / 2, 1), innerWidth - 1), y = Math.max(Math.min((box.top + box.bottom) / 2, top - 2), 1);
    const there = document.elementFromPoint(x, y);
    const covered = there && !e.contains(there) && !there.contains(e) && !e.closest("label")?.contains(there) && !there.closest(".glance")?.contains(e);
    const where = `${Math.round(box.top)} to ${Math.round(box.bottom)} of ${Math.round(top)}${covered ? `, below ${there.outerHTML.slice(0, 80)}` : ""}`;
    const scrolled = scrolledBy(e);
    stops.push({ ...named(e), marked: marked(e), hidden: hidden || covered ? where : "",
      inFooter: footer.contains(e), top: box.top + scrolled, bottom: box.bottom + scrolled, left: box.left, right: box.right });
  };
  addEventListener("keydown", (event) => { if (event.key === "Tab") look(); }, true);
  const kinds = "a[href], button, input:not([type=hidden]), select, textarea, summary, [tabindex='0']";
  const reachable = () => [...document.querySelectorAll(kinds)]
    .filter((e) => !e.matches(":disabled") && e.checkVisibility({ visibilityProperty: true }) && e.tabIndex >= 0)
    .filter((e) => e.type !== "radio" || e.checked || ![...document.querySelectorAll(`input[type=radio][name="${e.name}"]:checked`)].some((one) => one.form === e.form))
    .map(named);
  window.walk = { stops, reachable, look };
}
