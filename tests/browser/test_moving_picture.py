"""The moving picture in a real browser: its geometry, its hands, and what happens without WebGL.

Both clocks stand still but for what a test lets pass, and frames are counted as the page asks for
them. Workers and WebGL are the browser's own, and are waited for.
"""

import base64
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from datetime import timedelta
from itertools import product
from math import acos, cos, degrees, radians, sin
from operator import mul

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, Route, expect

from app.base.clock import VirtualClock
from app.sun.horizon import Horizon
from app.sun.trigonometry import SCALAR
from app.tracker.mounts.kinematics import direction
from app.tracker.mounts.usual import mounted
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import Pair
from tests.browser.conftest import BEAT, Plant, Served, go, listen, now, running
from tests.fake_data import NOON
from tests.fakes import FakeMachine
from tests.patience import PATIENCE_MS, until

T1 = "/trackers/T1"
FRAME_MS = 16
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
NORMALS = """async ({mount, angles}) => {
  const script = document.querySelector('script[src*="js/scene.js"]').src;
  const { anglesOf, pose } = await import(script.replace('scene.js', 'view3d/mounts.js'));
  return angles.map(([azimuth, elevation]) => {
    const at = anglesOf(mount, { azimuth, elevation });
    return { at, ...pose(mount, at) };
  });
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
TALLY = """(() => {
  const [ask, forget, send] = [requestAnimationFrame, cancelAnimationFrame, Worker.prototype.postMessage];
  const [waiting, tally] = [new Set(), { asked: 0, begun: false }];
  let [unpainted, done] = [0, null];
  self.requestAnimationFrame = (work) => {
    const id = ask((at) => { waiting.delete(id); work(at); });
    waiting.add(id);
    tally.asked += 1;
    return id;
  };
  self.cancelAnimationFrame = (id) => { waiting.delete(id); forget(id); };
  Worker.prototype.postMessage = function (order, ...more) {
    if (order.order === "begin") {
      tally.begun = true;
      this.addEventListener("message", ({ data }) => {
        unpainted = data === "painted" ? unpainted - 1 : 0;
        if (!unpainted) done?.();
      });
    }
    if (order.order === "paint") unpainted += 1;
    send.call(this, order, ...more);
  };
  tally.painted = async () => {
    if (unpainted) await new Promise((resolve) => { done = resolve; });
    return waiting.size;
  };
  self.tally = tally;
})()"""
"""Counts the frames a page asks for; `painted` tells, once the worker has painted all, how many are due."""


LOOKED = """() => new Promise((done) => {
  new IntersectionObserver(done).observe(document.querySelector(".scene"));
})"""
"""Resolves once the page has been told whether the picture is on the screen."""


@dataclass
class Panel:
    """One served panel for all tests here, on a clock that stands still, and one tab in front of it."""

    browser: Browser
    plant: Plant
    clock: VirtualClock
    page: Page = field(init=False)
    complaints: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.page = self.context().new_page()
        listen(self.page, self.complaints)

    @property
    def machine(self) -> FakeMachine:
        return self.plant.machine

    def context(self) -> BrowserContext:
        """Return a browser whose clock stands still, and whose frames are counted."""
        context = self.browser.new_context(
            viewport={"width": 1280, "height": 800}, timezone_id="Europe/Istanbul"
        )
        context.set_default_timeout(PATIENCE_MS)
        context.clock.install(time=NOON)
        context.clock.pause_at(NOON)
        context.add_init_script(TALLY)
        return context

    def open(self, path: str, page: Page | None = None) -> Page:
        page = page or self.page
        go(page, self.plant.url + path)
        return page

    def turn(self, azimuth_deg: float, elevation_deg: float, tracker: str = "T1") -> None:
        """Have the panel face another direction, and the page told of it."""
        self.machine.trackers[tracker].position = Pair(azimuth_deg, elevation_deg)
        now(self.plant, lambda: self.clock.advance(BEAT))


@pytest.fixture(scope="module")
def served(browser: Browser) -> Iterator[Panel]:
    clock = VirtualClock(NOON)
    with running(Served(FakeMachine(clock))) as plant:
        panel = Panel(browser, plant, clock)
        yield panel
        panel.page.context.close()


@pytest.fixture
def panel(served: Panel) -> Iterator[Panel]:
    served.machine.trackers["T1"].config = TrackerConfig("T1", "North field")
    served.machine.site = replace(served.machine.site, horizon=HILLS)
    served.turn(180.0, 45.0)
    yield served
    served.page.unroute_all(behavior="ignoreErrors")
    said = [one for one in served.complaints if "CONTEXT_LOST_WEBGL" not in one]
    served.complaints.clear()
    assert said == []


@pytest.fixture
def live(panel: Panel) -> Page:
    """The live page as it is at first, once its picture stands still."""
    if not panel.page.url.endswith(T1) or panel.page.locator('.scene[data-painter="webgl2"]').count() == 0:
        panel.open(T1)
    expect(panel.page.locator('[data-live="measured.azimuth_deg"]')).to_have_text("180.00°")
    panel.page.locator(".scene").press("Home")
    settled(panel.page)
    return panel.page


def begin_with(text: str, route: Route) -> None:
    answer = route.fetch()
    route.fulfill(response=answer, body=f"{text}\n{answer.text()}")


def share(page: Page, colour: tuple[int, int, int]) -> float:
    """Return how much of the picture has about this colour, as it is on the screen."""
    shot = page.locator(".scene").screenshot()
    return float(page.evaluate(COUNT, [base64.b64encode(shot).decode(), list(colour)]))


def sees_cells(page: Page) -> None:
    """Wait for the panel's cells: what a worker has painted comes to the screen a frame or two later."""
    until(lambda: share(page, CELL) > 0.02, "the panel's cells are on the screen")


def frames(page: Page) -> int:
    return int(page.locator(".scene").get_attribute("data-frames") or 0)


def asked(page: Page) -> int:
    """Return how many frames the page has asked for."""
    return int(page.evaluate("tally.asked"))


def settled(page: Page, painter: str = "webgl2") -> int:
    """Let frames pass until the picture stands still, and return how often it was painted by then."""
    page.wait_for_selector(f'.scene[data-painter="{painter}"]')
    while page.evaluate("tally.painted()"):
        page.clock.run_for(FRAME_MS)
    return frames(page)


def turned(panel: Panel, page: Page, azimuth_deg: float, elevation_deg: float) -> int:
    """Return how often a page is painted while the panel turns to another direction."""
    before = settled(page)
    panel.turn(azimuth_deg, elevation_deg)
    expect(page.locator('[data-live="measured.azimuth_deg"]')).to_have_text(f"{azimuth_deg:.2f}°")
    return settled(page) - before


def test_on_every_mount_the_panel_stands_as_the_machine_says(live: Page) -> None:
    """First and second angle, and the panel's normal, against the machine's own kinematics."""
    for kind, latitude_deg in product(MountKind, (41.3,)):
        mount = mounted(TrackerConfig("T1", "North"), kind, latitude_deg).mount
        seconds = (-20.0, 0.0, 23.0) if kind is MountKind.EQUATORIAL else (10.0, 45.0, 88.0)
        asked = list(product((-100.0, -35.0, 0.0, 12.5, 58.0), seconds))
        faced = [direction(mount, first_deg, second_deg, SCALAR) for first_deg, second_deg in asked]
        told = {
            "kind": kind.value,
            "axis_azimuth_deg": mount.axis_azimuth_deg,
            "axis_tilt_deg": mount.axis_tilt_deg,
        }
        found = live.evaluate(NORMALS, {"mount": told, "angles": faced})
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


def test_it_is_painted_by_webgl_and_only_when_something_changes(panel: Panel, live: Page) -> None:
    sees_cells(live)
    before = asked(live)
    live.clock.run_for(1_000)
    assert turned(panel, live, 180.01, 45.0) == 0, "nobody sees a hundredth of a degree"
    assert asked(live) == before, "it stands still, so no frame is asked for"
    assert turned(panel, live, 195.0, 50.0) > 4, "it glides"
    live.emulate_media(reduced_motion="reduce")
    assert turned(panel, live, 180.0, 30.0) == 1, "it is there at once"
    live.emulate_media(reduced_motion="null")


def test_below_the_screens_edge_nothing_is_painted_or_prepared(panel: Panel) -> None:
    page = panel.page
    page.set_viewport_size({"width": 390, "height": 300})
    panel.open(T1)
    page.evaluate(LOOKED)
    assert not page.evaluate("tally.begun")
    page.locator(".scene").scroll_into_view_if_needed()
    assert settled(page) > 0
    page.set_viewport_size({"width": 1280, "height": 800})


def test_it_turns_by_mouse_finger_keyboard_and_keys(live: Page) -> None:
    scene, shots = live.locator(".scene"), []

    def seen() -> bytes:
        live.mouse.move(2, 2)
        scene.focus()
        settled(live)
        return scene.screenshot()

    shots.append(seen())
    box = scene.bounding_box()
    assert box is not None
    live.mouse.move(box["x"] + 150, box["y"] + 200)
    live.mouse.down()
    live.mouse.move(box["x"] + 250, box["y"] + 170, steps=5)
    live.mouse.up()
    settled(live)
    let_go = asked(live)
    live.mouse.move(box["x"] + 300, box["y"] + 200, steps=3)
    assert asked(live) == let_go, "let go: it turns no further"
    shots.append(seen())
    live.keyboard.press("ArrowLeft")
    shots.append(seen())
    live.get_by_role("button", name="Raise the viewpoint").click()
    shots.append(seen())
    hand = live.context.new_cdp_session(live)
    at = {"x": box["x"] + 100, "y": box["y"] + 180}
    hand.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [at]})
    for step in range(1, 6):
        moved = {"x": at["x"] + 20 * step, "y": at["y"]}
        hand.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [moved]})
    hand.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    shots.append(seen())
    assert len(set(shots)) == len(shots)
    live.keyboard.press("Home")
    assert seen() == shots[0]


def test_without_webgl_the_same_scene_is_drawn(panel: Panel) -> None:
    context = panel.context()
    page = context.new_page()
    page.route("**/view3d/worker.js", lambda route: begin_with(NO_WEBGL, route))
    panel.open(T1, page)
    settled(page, "drawn")
    sees_cells(page)
    context.close()


def test_a_lost_context_is_bridged_and_taken_back(panel: Panel) -> None:
    page = panel.page
    page.route("**/view3d/worker.js", lambda route: begin_with(KEEP_CONTEXT, route))
    panel.open(T1)
    settled(page)
    painting = page.workers[0]
    painting.evaluate(
        "self.loser = self.lastContext.getExtension('WEBGL_lose_context'); self.loser.loseContext()"
    )
    settled(page, "drawn")
    sees_cells(page)
    painting.evaluate("self.loser.restoreContext()")
    settled(page)
    sees_cells(page)


def test_a_recording_from_before_limits_were_kept_plays_in_the_picture(panel: Panel) -> None:
    page = panel.open("/recordings/show-1")
    page.wait_for_selector("#angles canvas")
    before = settled(page)
    page.get_by_role("button", name="Play").click()
    page.clock.run_for(1_000)
    page.get_by_role("button", name="Pause").click()
    assert settled(page) > before
    assert float(page.locator("#player-scrubber").input_value()) == pytest.approx(1.0, abs=0.02)


def test_trends_go_on_while_one_looks(panel: Panel) -> None:
    page = panel.open(f"{T1}/trends?span=10min")
    expect(page.locator("#trends-state")).to_contain_text("the curves begin now")
    now(panel.plant, lambda: panel.clock.advance(timedelta(seconds=1)))
    page.wait_for_selector("#trend-azimuth canvas")
    expect(page.locator("#trend-wind .chart")).to_be_hidden()
    expect(page.locator("#trend-wind p")).to_have_text("No data was recorded in this time span.")
    assert "format=csv" in (page.locator("#trends-csv").get_attribute("href") or "")
