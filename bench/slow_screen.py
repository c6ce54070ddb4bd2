"""Slow screens: first paint and answers to touches at a quarter of the CPU's speed, in Chromium"""

import statistics
import tempfile
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from bench.pages import PAGES
from bench.table import Row, alone, at_most
from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench slow_screen"
SLOWER = 4
PAINT_LIMIT_MS = 1000.0
INTERACTION_LIMIT_MS = 100.0
NOTED_MS = 16.0
"""Chromium notes no interaction that is answered sooner."""
LOADED = "document.readyState === 'complete' && document.documentElement.dataset.link === 'live'"
WATCH = """
window.slowest = 0;
new PerformanceObserver((seen) => {
  for (const one of seen.getEntries()) {
    if (one.interactionId) window.slowest = Math.max(window.slowest, one.duration);
  }
}).observe({ type: 'event', durationThreshold: 16, buffered: true });
"""
THEMED = """
[window.pressedAt, window.slowestTheme] = [0, 0];
addEventListener('pointerup', (event) => { window.pressedAt = event.timeStamp; }, true);
new MutationObserver(() => requestAnimationFrame(() => setTimeout(() => {
  window.slowestTheme = Math.max(window.slowestTheme, performance.now() - window.pressedAt);
}))).observe(document, { attributes: true, subtree: true, attributeFilter: ['data-theme'] });
"""
FIRST_PAINT = "performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? 0"
SETTLED = "new Promise((done) => setTimeout(done, 250))"


@dataclass(frozen=True)
class Touch:
    """Something a person does on a page: what is tapped, and what is typed there."""

    page: str
    target: str
    typed: str = ""


TOUCHES = {
    "theme key": Touch("overview", "#theme-form .theme-key"),
    "a language's list": Touch("overview", ".language summary"),
    "typing a latitude": Touch("location", "#f-latitude", "41.2867"),
    "side of the equator": Touch("location", 'label:has([name="latitude_side"][value="S"])'),
    "choice of a mode": Touch("mode", 'label:has(input[value="azimuth"])'),
    "help": Touch("homing", ".help summary"),
    "turning the picture": Touch("live", ".scene-keys .key:last-child"),
    "a line of the journal's filter": Touch("journal", "#f-text", "wind"),
    "typing the minutes of a show": Touch("show", "#f-minutes", "0.25"),
}


@dataclass(frozen=True, slots=True)
class Size:
    """How many pages and touches there are, and how often each."""

    pages: int = len(PAGES)
    touches: int = len(TOUCHES)
    times: int = 2


SMALL = Size(pages=1, touches=1, times=1)


def measure(size: Size = Size()) -> list[Row]:
    """Return the slowest first paint of every page, and the slowest answer to each touch."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            _commission(product.url)
            with chromium() as browser:
                touches = islice(TOUCHES.items(), size.touches)
                answers = {name: _answer_ms(browser, product.url, one, size.times) for name, one in touches}
                themed_ms = _themed_ms(browser, product.url, size.times)
                pages = islice(PAGES.items(), size.pages)
                paints = {n: _first_paints(browser, product.url + path, size.times) for n, path in pages}
        finally:
            product.stop()
    rows = [_answer_row(name, took, size.times) for name, took in answers.items()]
    return [_paint_row(paints, size.times), *rows, _themed_row(themed_ms, size.times)]


def _commission(url: str) -> None:
    calling = Integrator(url)
    calling.place_and_time()
    calling.until_allowed("set_home")
    calling.zero()
    calling.close()


def _slow_tab(browser: Chromium, url: str) -> tuple[Tab, str]:
    """Open a page on a slow processor in a profile that has never seen it."""
    context = str(browser.send("Target.createBrowserContext")["browserContextId"])
    target = browser.send("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
    session = browser.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    tab = Tab(browser, str(target), str(session))
    tab.send("Page.enable")
    tab.send("Emulation.setCPUThrottlingRate", rate=SLOWER)
    tab.send("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
    tab.send("Page.navigate", url=url)
    tab.until(LOADED, f"{url} is loaded and live", within_s=30.0)
    return tab, context


def _first_paints(browser: Chromium, url: str, times: int) -> list[float]:
    paints = []
    for _ in range(times):
        tab, context = _slow_tab(browser, url)
        tab.until(f"({FIRST_PAINT}) > 0", "something is painted")
        paints.append(float(tab.evaluate(FIRST_PAINT)))
        browser.send("Target.disposeBrowserContext", browserContextId=context)
    return paints


def _answer_ms(browser: Chromium, url: str, touch: Touch, times: int) -> float:
    """Return how long the slowest of a few touches waited for its next paint."""
    tab, context = _slow_tab(browser, url + PAGES[touch.page])
    for _ in range(times):
        tab.until(f"document.querySelector({touch.target!r}) !== null", f"{touch.target} is there")
        tab.click(touch.target)
        for letter in touch.typed:
            tab.key("keyDown", letter, "", 0)
            tab.key("keyUp", letter, "", 0)
        tab.evaluate(SETTLED)
    slowest_ms = float(tab.evaluate("window.slowest"))
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return slowest_ms


def _themed_ms(browser: Chromium, url: str, times: int) -> float:
    """Return how long the slowest of a few touches of the theme key took to paint the whole page anew."""
    tab, context = _slow_tab(browser, url + PAGES["overview"])
    tab.evaluate(THEMED)
    for _ in range(times):
        tab.click(TOUCHES["theme key"].target)
        tab.evaluate(SETTLED)
    slowest_ms = float(tab.evaluate("window.slowestTheme"))
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return slowest_ms


def _paint_row(paints: dict[str, list[float]], times: int) -> Row:
    medians = {name: statistics.median(times_ms) for name, times_ms in paints.items()}
    slowest = max(medians, key=lambda name: medians[name])
    worst_ms = max(max(times_ms) for times_ms in paints.values())
    name = f"first contentful paint at 1/{SLOWER} of the CPU, cold cache, {len(paints)} pages {times} times"
    told = f"slowest median {medians[slowest]:.0f} ms ({slowest}), slowest of all {worst_ms:.0f} ms"
    return at_most(name, medians[slowest], PAINT_LIMIT_MS, "ms", COMMAND, ours=told)


def _answer_row(name: str, took_ms: float, times: int) -> Row:
    what = f"interaction to next paint at 1/{SLOWER} of the CPU: {name}, slowest of {times}"
    return at_most(what, max(took_ms, NOTED_MS), INTERACTION_LIMIT_MS, "ms", COMMAND)


def _themed_row(took_ms: float, times: int) -> Row:
    what = f"the whole page in the next theme at 1/{SLOWER} of the CPU, slowest of {times}"
    return alone(what, f"{took_ms:.0f} ms", COMMAND)
