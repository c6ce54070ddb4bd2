"""The moving picture in a real browser: its geometry, its hands, and what happens without WebGL."""

import asyncio
import base64
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import datetime
from itertools import product
from math import acos, cos, degrees, radians, sin
from operator import mul
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Route

from app.base.clock import SystemClock
from app.sun.horizon import Horizon
from app.sun.trigonometry import SCALAR
from app.tracker.mounts.kinematics import direction
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import Pair
from tests.browser.conftest import SCREENS, SOFTWARE_NOTE, Served
from tests.e2e.chromium import PAGE_READY
from tests.fake_data import NOON
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_MS

T1 = "/trackers/T1"
SIZES = ((1920, 1080), (1280, 800), (1024, 768), (390, 844))
PAGES = ("/", "/?layout=rows", T1, f"{T1}/sun-path", f"{T1}/trends", "/site/horizon")
HILLS = Horizon(((0.0, 2.0), (100.0, 12.0), (180.0, 3.0), (250.0, 22.0)))
NO_WEBGL = """const given = OffscreenCanvas.prototype.getContext;
OffscreenCanvas.prototype.getContext = function (kind, ...more) {
  return kind === 'webgl2' ? null : given.call(this, kind, ...more);
};"""
KEEP_CONTEXT = """const given = OffscreenCanvas.prototype.getContext;
OffscreenCanvas.prototype.getContext = function (kind, ...more) {
  const found = given.call(this, kind, ...more);
  if (kind === 'webgl2') self.lastContext = found;
  return found;
};"""
NO_WORKER = "delete HTMLCanvasElement.prototype.transferControlToOffscreen"
NORMALS = """async ({mount, angles}) => {
  const script = document.querySelector('script[src*="js/scene.js"]').src;
  const { anglesOf, pose } = await import(script.replace('scene.js', 'view3d/mounts.js'));
  return angles.map(([azimuth, elevation]) => {
    const at = anglesOf(mount, { azimuth, elevation });
    return { at, ...pose(mount, at) };
  });
}"""
STAGED = """async () => {
  const script = document.querySelector('script[src*="js/scene.js"]').src;
  const { PanelScene } = await import(script.replace('scene.js', 'panel3d.js'));
  const { live } = await import(script.replace('scene.js', 'live.js'));
  const holder = document.createElement('div');
  holder.dataset.view = document.querySelector('[data-scene]').dataset.view;
  const scene = new PanelScene(holder);
  const measured = live.tracker.measured;
  const panel = { azimuth: measured.azimuth_deg, elevation: measured.elevation_deg };
  scene.show({ sun: null, target: null, panel });
  scene.now = scene.wanted;
  return { normal: scene.stage().normal, measured };
}"""
COUNT = """async ([picture, wanted]) => {
  const image = new Image();
  image.src = 'data:image/png;base64,' + picture;
  await image.decode();
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width: image.width, height: image.height });
  const pen = canvas.getContext('2d');
  pen.drawImage(image, 0, 0);
  const { data } = pen.getImageData(0, 0, image.width, image.height);
  let count = 0;
  for (let at = 0; at < data.length; at += 4) {
    if (wanted.every((value, index) => Math.abs(data[at + index] - value) < 26)) count += 1;
  }
  return count / (data.length / 4);
}"""
CELL = (43, 74, 107)
FIT = """() => ({
  over: document.documentElement.scrollWidth - innerWidth,
  small: [...document.querySelectorAll('a, button, input:not([type=hidden]), select, summary, textarea')]
    .filter(e => !e.closest('p, h2, h3, .reasons, .skip') && !e.classList.contains('skip'))
    .map(e => [e, e.getBoundingClientRect()])
    .filter(([e, box]) => box.width > 0 && (box.width < 60 || box.height < 60))
    .map(([e, box]) => `${e.tagName} ${e.className} ${e.textContent.trim()} ${box.width}x${box.height}`),
})"""


class NoonClock(SystemClock):
    """Runs on from noon, so that the sun shines on the panel at whatever hour the tests run."""

    def __init__(self) -> None:
        super().__init__()
        self._late = NOON - super().now()

    def now(self) -> datetime:
        return super().now() + self._late


class Panel:
    """One served panel for all tests here, and the pages that were opened on it."""

    def __init__(self, browser: Browser, machine: FakeMachine, url: str) -> None:
        self.browser, self.machine, self.url = browser, machine, url
        self.contexts: list[BrowserContext] = []
        self.complaints: list[str] = []

    def open(
        self, path: str, *, init: str = "", worker: str = "", allow: str = SOFTWARE_NOTE, **options: Any
    ) -> Page:
        """Open a page; `init` runs before it does, and `worker` before the thread that paints."""
        context = self.browser.new_context(
            viewport={"width": 1280, "height": 800}, timezone_id="Europe/Istanbul", **options
        )
        self.contexts.append(context)
        context.set_default_timeout(PATIENCE_MS)
        page = context.new_page()
        if init:
            page.add_init_script(init)
        if worker:
            page.route("**/view3d/worker.js", lambda route: begin_with(worker, route))
        page.on("console", lambda one: self._complain(one.type, one.text, allow))
        page.on("pageerror", lambda error: self.complaints.append(f"uncaught: {error}"))
        page.goto(self.url + path)
        page.wait_for_selector(PAGE_READY)
        return page

    def _complain(self, kind: str, text: str, allow: str) -> None:
        if kind in ("error", "warning") and SOFTWARE_NOTE not in text and allow not in text:
            self.complaints.append(f"{kind}: {text}")


@pytest.fixture(scope="module")
def served() -> Iterator[Served]:
    served = Served(FakeMachine(NoonClock()))
    thread = threading.Thread(target=lambda: asyncio.run(served.run()), daemon=True)
    thread.start()
    assert served.ready.wait(20), "the panel did not start"
    yield served
    assert served.server is not None
    served.server.should_exit = True
    thread.join(20)
    assert not thread.is_alive(), "the panel did not stop"


@pytest.fixture
def panel(served: Served, browser: Browser) -> Iterator[Panel]:
    assert served.server is not None
    port = served.server.servers[0].sockets[0].getsockname()[1]
    machine = served.machine
    machine.trackers["T1"].config = TrackerConfig("T1", "North field")
    machine.trackers["T1"].position = Pair(180.0, 45.0)
    machine.site = replace(machine.site, horizon=HILLS)
    panel = Panel(browser, machine, f"http://127.0.0.1:{port}")
    yield panel
    for context in panel.contexts:
        context.close()
    assert panel.complaints == []


def begin_with(text: str, route: Route) -> None:
    answer = route.fetch()
    route.fulfill(response=answer, body=f"{text}\n{answer.text()}")


def share(page: Page, colour: tuple[int, int, int]) -> float:
    """Return how much of the picture has about this colour, as it is on the screen."""
    shot = page.locator(".scene").screenshot()
    return float(page.evaluate(COUNT, [base64.b64encode(shot).decode(), list(colour)]))


def azimuth(page: Page) -> str:
    return page.locator('[data-live="measured.azimuth_deg"]').inner_text()


def frames(page: Page) -> int:
    return int(page.locator(".scene").get_attribute("data-frames") or 0)


def settled(page: Page) -> int:
    """Wait until the picture stands still, and return how often it was painted by then."""
    page.wait_for_selector(".scene[data-frames]")
    before = -1
    while before != frames(page):
        before = frames(page)
        page.wait_for_timeout(200)
    return before


@contextmanager
def painted(page: Page) -> Iterator[None]:
    """Go on once what the block did is on the screen, and stands still."""
    before = frames(page)
    yield
    until(page, lambda: frames(page) > before)
    settled(page)


def until(page: Page, reached: Callable[[], bool]) -> None:
    """Wait for what is true soon; a page under this policy lets nobody evaluate a string."""
    for _ in range(200):
        if reached():
            return
        page.wait_for_timeout(25)
    pytest.fail("it did not come about within five seconds")


def test_on_every_mount_the_panel_stands_as_the_machine_says(panel: Panel) -> None:
    """First and second angle, and the panel's normal, against the machine's own kinematics."""
    page = panel.open(T1)
    for kind, latitude_deg in product(MountKind, (41.3, -33.9)):
        mount = mounted(TrackerConfig("T1", "North"), kind, latitude_deg).mount
        seconds = (-20.0, 0.0, 23.0) if kind is MountKind.EQUATORIAL else (10.0, 45.0, 88.0)
        asked = list(product((-100.0, -35.0, 0.0, 12.5, 58.0), seconds))
        faced = [direction(mount, first_deg, second_deg, SCALAR) for first_deg, second_deg in asked]
        told = {
            "kind": kind.value,
            "axis_azimuth_deg": mount.axis_azimuth_deg,
            "axis_tilt_deg": mount.axis_tilt_deg,
        }
        found = page.evaluate(NORMALS, {"mount": told, "angles": faced})
        for angles, (azimuth_deg, elevation_deg), pose in zip(asked, faced, found, strict=True):
            assert separation(pose["normal"], azimuth_deg, elevation_deg) < 0.1, kind
            assert pose["at"]["first"] == pytest.approx(angles[0], abs=1e-6), kind
            if not mount.single_axis:
                assert pose["at"]["second"] == pytest.approx(angles[1], abs=1e-6), kind
            assert sum(map(mul, pose["up"], pose["normal"])) == pytest.approx(0.0, abs=1e-9)


def separation(normal: list[float], azimuth_deg: float, elevation_deg: float) -> float:
    azimuth, elevation = radians(azimuth_deg), radians(elevation_deg)
    there = (cos(elevation) * sin(azimuth), cos(elevation) * cos(azimuth), sin(elevation))
    return degrees(acos(min(1.0, sum(map(mul, normal, there)))))


def test_the_scene_shows_the_snapshots_direction(panel: Panel) -> None:
    panel.machine.trackers["T1"].position = Pair(222.22, 37.5)
    page = panel.open(T1)
    until(page, lambda: azimuth(page) == "222.22°")
    staged = page.evaluate(STAGED)
    assert staged["measured"] == {"azimuth_deg": 222.22, "elevation_deg": 37.5}
    assert separation(staged["normal"], 222.22, 37.5) < 0.1


def test_it_is_painted_by_webgl_and_only_when_something_changes(panel: Panel) -> None:
    page = panel.open(T1)
    page.wait_for_selector('.scene[data-painter="webgl2"]')
    before = settled(page)
    assert share(page, CELL) > 0.02, "the panel's cells are on the screen"
    page.wait_for_timeout(600)
    assert frames(page) - before <= 1, "it stands still, so nothing is painted"
    panel.machine.trackers["T1"].position = Pair(195.0, 50.0)
    until(page, lambda: frames(page) > before + 4)


def test_below_the_screens_edge_nothing_is_painted_or_prepared(panel: Panel) -> None:
    page = panel.open(T1)
    page.set_viewport_size({"width": 390, "height": 300})
    page.reload()
    page.wait_for_selector(PAGE_READY)
    until(page, lambda: page.locator(".scene-keys").count() == 1)
    assert page.locator(".scene").get_attribute("data-painter") is None
    page.locator(".scene").scroll_into_view_if_needed()
    page.wait_for_selector('.scene[data-painter="webgl2"]')
    until(page, lambda: frames(page) > 0)


def test_it_turns_by_mouse_keyboard_and_keys(panel: Panel) -> None:
    page = panel.open(T1)
    scene = page.locator(".scene")
    settled(page)
    shots = [scene.screenshot()]
    box = scene.bounding_box()
    assert box is not None
    page.mouse.move(box["x"] + 150, box["y"] + 200)
    page.mouse.down()
    with painted(page):
        page.mouse.move(box["x"] + 250, box["y"] + 170, steps=5)
        page.mouse.up()
    shots.append(scene.screenshot())
    page.mouse.move(box["x"] + 300, box["y"] + 200, steps=3)
    assert scene.screenshot() == shots[-1], "let go: it turns no further"
    scene.focus()
    with painted(page):
        page.keyboard.press("ArrowLeft")
    shots.append(scene.screenshot())
    with painted(page):
        page.get_by_role("button", name="Raise the viewpoint").click()
    page.mouse.move(2, 2)
    scene.focus()
    shots.append(scene.screenshot())
    with painted(page):
        page.keyboard.press("Home")
    assert len({bytes(one) for one in shots}) == len(shots)


def test_a_finger_turns_it(panel: Panel) -> None:
    page = panel.open(T1, has_touch=True)
    before = settled(page)
    box = page.locator(".scene").bounding_box()
    assert box is not None
    hand = page.context.new_cdp_session(page)
    at = {"x": box["x"] + 100, "y": box["y"] + 180}
    hand.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [at]})
    for step in range(1, 6):
        moved = {"x": at["x"] + 20 * step, "y": at["y"]}
        hand.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [moved]})
    hand.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    until(page, lambda: frames(page) > before)


def test_who_wants_no_motion_sees_none(panel: Panel) -> None:
    page = panel.open(T1, reduced_motion="reduce")
    before = settled(page)
    panel.machine.trackers["T1"].position = Pair(140.0, 30.0)
    until(page, lambda: azimuth(page) == "140.00°")
    assert settled(page) - before <= 2, "it is there at once"


@pytest.mark.parametrize("lacking", [{"worker": NO_WEBGL}, {"init": NO_WORKER}])
def test_without_webgl_the_same_scene_is_drawn(lacking: dict[str, str], panel: Panel) -> None:
    page = panel.open(T1, **lacking)
    page.wait_for_selector('.scene[data-painter="drawn"]')
    settled(page)
    assert share(page, CELL) > 0.02
    page.locator(".scene").screenshot(path=SCREENS / "scene-drawn.png")


def test_a_lost_context_is_bridged_and_taken_back(panel: Panel) -> None:
    page = panel.open(T1, worker=KEEP_CONTEXT, allow="CONTEXT_LOST_WEBGL")
    settled(page)
    painting = page.workers[0]
    painting.evaluate(
        "self.loser = self.lastContext.getExtension('WEBGL_lose_context'); self.loser.loseContext()"
    )
    page.wait_for_selector('.scene[data-painter="drawn"]')
    settled(page)
    assert share(page, CELL) > 0.02
    with painted(page):
        painting.evaluate("self.loser.restoreContext()")
        page.wait_for_selector('.scene[data-painter="webgl2"]')
    assert share(page, CELL) > 0.02


def test_every_mount_has_its_picture(panel: Panel) -> None:
    tracker = panel.machine.trackers["T1"]
    page = panel.open(T1)
    for kind in sorted(set(MountKind) - {MountKind.AZIMUTH_ELEVATION}):
        tracker.config = mounted(TrackerConfig("T1", "North field"), kind, 41.3)
        azimuth_deg, elevation_deg = direction(tracker.config.mount, -30.0, 10.0, SCALAR)
        tracker.position = Pair(azimuth_deg % 360.0, elevation_deg)
        page.reload()
        page.wait_for_selector(PAGE_READY)
        settled(page)
        page.locator(".scene").screenshot(path=SCREENS / f"scene-{kind}.png")
        assert share(page, CELL) > 0.01, kind


def test_a_recording_from_before_limits_were_kept_plays_in_the_picture(panel: Panel) -> None:
    page = panel.open("/recordings/show-1")
    page.wait_for_selector("#angles canvas")
    before = settled(page)
    page.get_by_role("button", name="Play").click()
    until(page, lambda: frames(page) > before + 20)
    page.locator("#player-scrubber").evaluate(
        "slider => { slider.value = slider.max / 2; slider.dispatchEvent(new Event('input')); }"
    )
    settled(page)
    assert share(page, CELL) > 0.01, "at noon the panel faces the one who looks"


@pytest.mark.parametrize("path", PAGES)
def test_pages_fit_at_four_sizes(path: str, panel: Panel) -> None:
    """The pictures follow the size of the screen with the next frame, which comes late on a busy computer."""
    page = panel.open(path)
    for width, height in SIZES:
        page.set_viewport_size({"width": width, "height": height})
        until(page, lambda: page.evaluate(FIT) == {"over": 0, "small": []})


def test_trends_go_on_while_one_looks(panel: Panel) -> None:
    page = panel.open(f"{T1}/trends?span=10min")
    page.wait_for_selector("#trend-azimuth canvas")
    assert page.locator("#trend-wind .chart").is_hidden()
    assert page.locator("#trend-wind p").inner_text() == "No data was recorded in this time span."
    assert "format=csv" in (page.locator("#trends-csv").get_attribute("href") or "")
    page.get_by_role("link", name="7 days").click()
    page.wait_for_selector('#trends-state[data-seconds="604800"]')
    page.wait_for_selector("#trend-elevation canvas")


def test_a_tap_on_a_tracker_opens_it_and_its_bars_move(panel: Panel) -> None:
    page = panel.open("/?layout=rows")
    mark = page.locator('[data-tracker="T1"] [data-bar="azimuth"] [data-at="measured"]')
    assert mark.get_attribute("transform") == "translate(100.0 0)"
    panel.machine.trackers["T1"].position = Pair(270.0, 45.0)
    page.wait_for_selector('[data-tracker="T1"] [data-at="measured"][transform="translate(150.0 0)"]')
    card = page.locator('.glance[data-tracker="T1"]').bounding_box()
    assert card is not None
    page.mouse.click(card["x"] + card["width"] / 2, card["y"] + card["height"] - 12)
    page.wait_for_url("**/trackers/T1")


def test_the_sun_path_moves_with_the_panel(panel: Panel) -> None:
    page = panel.open(f"{T1}/sun-path")
    marks = page.locator('.cartesian [data-mark="panel"]')
    until(page, lambda: marks.get_attribute("visibility") == "visible")
    assert marks.get_attribute("transform") == "translate(416.00 151.00)"
    page.screenshot(path=SCREENS / "sun-path.png")
