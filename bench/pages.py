"""Pages: what each weighs, when the first can be used, and how fast the moving picture runs, in Chromium"""

import statistics
import tempfile
from dataclasses import dataclass
from itertools import islice
from pathlib import Path

from bench.table import Row, at_least, at_most
from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench pages"
LIMIT_BYTES = 150_000
LIMIT_MS = 1000.0
T1 = "/trackers/T1"
PAGES = {
    "overview": "/",
    "live": T1,
    "location": f"{T1}/commissioning/location",
    "clock": f"{T1}/commissioning/clock",
    "homing": f"{T1}/commissioning/homing",
    "mode": f"{T1}/commissioning/mode",
    "orientation": f"{T1}/commissioning/mode/orientation",
    "run": f"{T1}/commissioning/run",
    "sun check": f"{T1}/sun-check",
    "record": f"{T1}/record",
    "settings": f"{T1}/settings",
    "sun path": f"{T1}/sun-path",
    "trends": f"{T1}/trends",
    "horizon": "/site/horizon",
    "show": f"{T1}/show?date=2027-06-21&start=05:07&end=20:19&minutes=3",
    "recordings": "/recordings",
    "simulate": "/simulate",
    "journal": "/journal",
}
NOTE_LIVE = """
new MutationObserver((_, seen) => {
  if (document.documentElement?.dataset.link !== 'live') return;
  window.liveAt = performance.now();
  seen.disconnect();
}).observe(document, {attributes: true, subtree: true, attributeFilter: ['data-link']});
"""
Painted = tuple[float, float]
"""Pictures a second, and the longest time between two in milliseconds."""
LEAST_RATE = 60.0
LONGEST_MS = 20_000
"""So long at most two pictures are waited for; a gap needs two."""
PLAY = """(() => {
  document.querySelector('input[name="player-speed"][value="3600"]').click();
  document.getElementById('player-play').click();
})()"""
WATCH = """(async () => {
  const [scene, times] = [document.querySelector('.scene'), []];
  await new Promise((done) => setTimeout(done, 500));
  const note = () => times.push(performance.now());
  new MutationObserver(note).observe(scene, {attributeFilter: ['data-frames']});
  const [before, begin] = [Number(scene.dataset.frames), performance.now()];
  do await new Promise((done) => setTimeout(done, WATCH_MS));
  while (times.length < 2 && performance.now() - begin < LONGEST_MS);
  const gaps = times.slice(1).map((at, index) => at - times[index]);
  return [(Number(scene.dataset.frames) - before) / (performance.now() - begin) * 1000, Math.max(...gaps)];
})()"""
SHOW = {"date": "2027-06-21", "duration_s": 180.0}
PAINTED = "document.querySelector('.scene').dataset.frames > 0"
LOADED = "document.readyState === 'complete' && window.liveAt !== undefined"
WEIGHT = """[...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')]
  .filter(one => !one.name.includes('/api/')).reduce((sum, one) => sum + one.transferSize, 0)"""


@dataclass(frozen=True, slots=True)
class Size:
    """How many pages are weighed, how often the first is opened, and how a picture is watched."""

    pages: int = len(PAGES)
    cold_starts: int = 15
    played: int = 3
    watch_s: float = 3.0


SMALL = Size(pages=1, cold_starts=1, played=1, watch_s=0.3)


def measure(size: Size = Size()) -> list[Row]:
    """Return the weight of every page, and the time until the first one is live."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            pages = dict(islice(PAGES.items(), size.pages)) | {
                "player": f"/recordings/{_simulated_day(product.url)}"
            }
            with chromium() as browser:
                weights = {name: _weight(browser, product.url + path) for name, path in pages.items()}
                times_ms = [_usable_ms(browser, product.url) for _ in range(size.cold_starts)]
                played = [_played(browser, product.url + pages["player"], size) for _ in range(size.played)]
                shown = _shown(browser, product.url, size)
        finally:
            product.stop()
    rows = [_weight_row(name, size) for name, size in sorted(weights.items(), key=lambda one: -one[1])]
    return [
        *rows,
        _time_row(times_ms),
        _rate_row("a recorded day played at 3,600 times the sun's speed", played, size),
        _rate_row("a solstice day shown in three minutes on the simulated tracker", shown, size),
    ]


def _simulated_day(url: str) -> str:
    calling = Integrator(url)
    calling.place_and_time()
    made = calling.post("/api/v1/simulations", {"tracker_id": "T1", "date": "2026-06-21", "step_s": 10})
    calling.close()
    return str(made["recording_id"])


def _cold(browser: Chromium, url: str) -> tuple[Tab, str]:
    """Open a page in a profile that has never seen it, and return once it is loaded and live."""
    context = str(browser.send("Target.createBrowserContext")["browserContextId"])
    target = browser.send("Target.createTarget", url="about:blank", browserContextId=context)["targetId"]
    session = browser.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    tab = Tab(browser, str(target), str(session))
    tab.send("Page.enable")
    tab.send("Page.addScriptToEvaluateOnNewDocument", source=NOTE_LIVE)
    tab.send("Page.navigate", url=url)
    tab.until(LOADED, "the page is loaded and live")
    return tab, context


def _weight(browser: Chromium, url: str) -> int:
    tab, context = _cold(browser, url)
    weight = int(tab.evaluate(WEIGHT))
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return weight


def _usable_ms(browser: Chromium, url: str) -> float:
    tab, context = _cold(browser, url + "/")
    usable_ms = float(tab.evaluate("window.liveAt"))
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return usable_ms


def _played(browser: Chromium, url: str, size: Size) -> Painted:
    """Play a recorded day at full speed and count what is painted."""
    tab, context = _cold(browser, url)
    tab.until("document.querySelector('#angles canvas') !== null", "the curves are drawn")
    tab.until(PAINTED, "the picture is there")
    tab.evaluate(PLAY)
    painted = _watched(tab, size)
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return painted


def _shown(browser: Chromium, url: str, size: Size) -> list[Painted]:
    """Run a show on the tracker and count what its page paints."""
    calling = Integrator(url)
    calling.zero()
    calling.command("set_mode", mode="dual")
    show_id = calling.post("/shows", SHOW)["show_id"]
    calling.post(f"/shows/{show_id}/go-to-start")
    calling.until(lambda seen: seen["show"]["phase"] == "ready", "the panel is at the start", within_s=120.0)
    tab, context = _cold(browser, f"{url}{T1}/shows/{show_id}")
    calling.post(f"/shows/{show_id}/run")
    calling.close()
    tab.until(PAINTED, "the picture is there")
    painted = [_watched(tab, size) for _ in range(size.played)]
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return painted


def _watched(tab: Tab, size: Size) -> Painted:
    """Return how many pictures a second were on the screen, and the longest time without a new one."""
    rate, longest_ms = tab.evaluate(
        WATCH.replace("WATCH_MS", f"{1000 * size.watch_s:.0f}").replace("LONGEST_MS", str(LONGEST_MS))
    )
    return float(rate), float(longest_ms)


def _rate_row(what: str, painted: list[Painted], size: Size) -> Row:
    slowest, longest_ms = min(rate for rate, _ in painted), max(gap_ms for _, gap_ms in painted)
    name = f"moving picture of {what}, WebGL in software, {len(painted)} times {size.watch_s:g} s"
    told = f"at least {slowest:.1f} frames/s, longest gap {longest_ms:.0f} ms"
    return at_least(name, slowest, LEAST_RATE, "frames/s", COMMAND, ours=told)


def _weight_row(name: str, size: int) -> Row:
    what = f"weight of page {name}, compressed, headers included, cold cache"
    return at_most(what, size / 1000.0, LIMIT_BYTES / 1000.0, "kB", COMMAND)


def _time_row(times_ms: list[float]) -> Row:
    name = (
        f"first page: from the request until its values are live, cold cache, {len(times_ms)} times, maximum"
    )
    told = f"median {statistics.median(times_ms):.0f} ms, max {max(times_ms):.0f} ms"
    return at_most(name, max(times_ms), LIMIT_MS, "ms", COMMAND, ours=told)
