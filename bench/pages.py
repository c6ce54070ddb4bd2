"""Pages: what each weighs, when the first can be used, and how fast the moving picture runs, in Chromium"""

import statistics
import tempfile
from pathlib import Path

from bench.table import Row
from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench pages"
LIMIT_BYTES = 150_000
LIMIT_MS = 1000.0
COLD_STARTS = 15
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
PLAYED = 3
LEAST_RATE = 60.0
PLAY = """(async () => {
  const frames = () => Number(document.querySelector('.scene').dataset.frames);
  document.querySelector('input[name="player-speed"][value="3600"]').click();
  document.getElementById('player-play').click();
  await new Promise((done) => setTimeout(done, 500));
  const [before, begin] = [frames(), performance.now()];
  await new Promise((done) => setTimeout(done, 3000));
  return (frames() - before) / (performance.now() - begin) * 1000;
})()"""
PAINTED = "document.querySelector('.scene').dataset.frames > 0"
LOADED = "document.readyState === 'complete' && window.liveAt !== undefined"
WEIGHT = """[...performance.getEntriesByType('navigation'), ...performance.getEntriesByType('resource')]
  .filter(one => !one.name.includes('/api/')).reduce((sum, one) => sum + one.transferSize, 0)"""


def measure() -> list[Row]:
    """Return the weight of every page, and the time until the first one is live."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            pages = PAGES | {"player": f"/recordings/{_simulated_day(product.url)}"}
            with chromium() as browser:
                weights = {name: _weight(browser, product.url + path) for name, path in pages.items()}
                times_ms = [_usable_ms(browser, product.url) for _ in range(COLD_STARTS)]
                rates = [_frames_a_second(browser, product.url + pages["player"]) for _ in range(PLAYED)]
        finally:
            product.stop()
    rows = [_weight_row(name, size) for name, size in sorted(weights.items(), key=lambda one: -one[1])]
    return [*rows, _time_row(times_ms), _rate_row(rates)]


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


def _frames_a_second(browser: Chromium, url: str) -> float:
    """Play a recorded day at full speed and count what is painted; without a graphics card, in software."""
    tab, context = _cold(browser, url)
    tab.until("document.querySelector('#angles canvas') !== null", "the curves are drawn")
    tab.until(PAINTED, "the picture is there")
    rate = float(tab.evaluate(PLAY))
    browser.send("Target.disposeBrowserContext", browserContextId=context)
    return rate


def _rate_row(rates: list[float]) -> Row:
    slowest = min(rates)
    return Row(
        f"moving picture of a day played at 3,600 times the sun's speed, WebGL in software, {PLAYED} times",
        f"at least {slowest:.0f} frames/s",
        f"{LEAST_RATE:.0f} frames/s",
        f"{slowest / LEAST_RATE:.2f}",
        COMMAND,
    )


def _weight_row(name: str, size: int) -> Row:
    return Row(
        f"weight of page {name}, compressed, headers included, cold cache",
        f"{size / 1000:.1f} kB",
        f"{LIMIT_BYTES / 1000:.0f} kB",
        f"{size / LIMIT_BYTES:.2f}",
        COMMAND,
    )


def _time_row(times_ms: list[float]) -> Row:
    return Row(
        f"first page: from the request until its values are live, cold cache, {len(times_ms)} times",
        f"median {statistics.median(times_ms):.0f} ms, max {max(times_ms):.0f} ms",
        f"{LIMIT_MS:.0f} ms",
        f"{max(times_ms) / LIMIT_MS:.2f}",
        COMMAND,
    )
