"""Whatever the tracker does and whoever has control, the four buttons to hold stay where they are."""

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from app.link.messages import Order, RequestControl
from app.link.weather_orders import ReportWeather
from app.simulation.faults import Fault, FaultKind
from app.tracker.commands.commands import Command, Home, SetHome, Stop, UndoHome
from app.tracker.state.snapshot import ActivityName
from app.tracker.weather.weather import Weather
from tests.browser.hands import LINK_MEASURED, middle
from tests.browser.site_stage import SiteStage, staged_site

HOMING = "/trackers/T1/commissioning/homing"
MAST = "/trackers/T1/mast"
DOWN = '[data-jog="elevation"][data-direction="-1"]'
RIGHT = '[data-jog="azimuth"][data-direction="1"]'
AT_LIMIT = '[data-lamp="elevation.at_lower_limit"][data-on="true"]'
LONG_MS = 240_000
COARSE_MS = 250
STORM = Weather(wind_mps=28.0)
BOXES = """() => document.fonts.ready.then(() => [...document.querySelectorAll("[data-jog]")]
  .map((one) => one.getBoundingClientRect()).map((box) => [box.x, box.y + scrollY, box.width, box.height]))"""


@pytest.fixture
def site(browser: Browser) -> Iterator[SiteStage]:
    with staged_site(browser) as found:
        yield found


@dataclass
class Walk:
    """Pages with the four buttons in two sizes and languages, and where the buttons were at first."""

    site: SiteStage
    pages: dict[str, Page]
    places: dict[str, Any] = field(default_factory=dict)
    moved: dict[str, Any] = field(default_factory=dict)

    def look(self, when: str) -> None:
        """Compare the places of the buttons with those of the first look."""
        self.site.advance(200)
        for name, page in self.pages.items():
            seen = page.evaluate(BOXES)
            assert len(seen) == 4
            if seen != self.places.setdefault(name, seen):
                self.moved[f"{name}: {when}"] = seen

    def order(self, command: Command | RequestControl | ReportWeather) -> None:
        """Have another user command something, elsewhere."""
        to = None if isinstance(command, RequestControl | ReportWeather) else "T1"
        order = Order(command, "ada", to, via="session", rank=2)
        given: list[object] = []
        self.site.do(lambda: given.append(asyncio.ensure_future(self.site.plant.machine.execute(order))))
        self.site.advance(500)

    def until(self, activity: ActivityName) -> None:
        self.site.until(lambda: self.site.tracker.activity is activity, within_ms=LONG_MS)

    def hold(self, page: Page, key: str, reached: Callable[[], object], when: str) -> None:
        """Hold a button until something is so, and let it go."""
        button = page.locator(key)
        self.site.until(lambda: page.locator(LINK_MEASURED).count() and button.is_enabled())
        page.mouse.move(*middle(button))
        page.mouse.down()
        self.site.until(reached, within_ms=LONG_MS)
        self.look(f"{when}, held")
        page.mouse.up()
        self.until(ActivityName.HOLDING)
        self.look(when)

    def jog(self) -> None:
        for name, page in self.pages.items():
            self.hold(page, RIGHT, lambda: self.site.is_jogging, f"jogged at {name}")

    def meet_a_limit(self) -> None:
        """Jog to the limit switch; from there every page is refused to go on."""
        first = next(iter(self.pages.values()))
        first.locator('[name="speed"][value="fast"]').check(force=True)
        self.hold(first, DOWN, lambda: first.locator(AT_LIMIT).count(), "at a limit")
        for name, page in self.pages.items():
            words = page.locator("#jog-words")
            self.hold(page, DOWN, words.inner_text, f"refused at {name}")

    def set_home(self) -> None:
        """Lose control, search the home switches twice, set the home position, and undo it."""
        site = self.site
        self.order(RequestControl(("T1",), takes=True, reason="at the tracker"))
        site.until(lambda: site.tracker.control.holder == "ada", within_ms=LONG_MS)
        self.look("control held by another user")
        self.order(Home())
        self.until(ActivityName.HOMING)
        self.look("homing")
        self.order(Stop())
        self.until(ActivityName.HOLDING)
        assert not site.tracker.homed
        self.look("homing was stopped")
        self.order(Home())
        site.until(lambda: site.tracker.homed, within_ms=LONG_MS)
        self.look("homed")
        self.order(SetHome())
        site.until(lambda: site.tracker.can_undo_home)
        self.look("home set")
        self.order(UndoHome())
        site.until(lambda: not site.tracker.can_undo_home)
        self.look("undone")

    def meet_a_storm(self) -> None:
        """Have wind at a tracker in manual, and a drive that falls silent and is stopped."""
        site = self.site
        self.order(ReportWeather(STORM))
        site.until(lambda: site.tracker.protection is not None)
        assert site.tracker.not_stowed is not None
        self.look("wind protection active")
        site.do(lambda: site.served.drives["T1"].inject(Fault(FaultKind.SILENCE)))
        site.until(lambda: site.tracker.unreachable is not None)
        self.look("the drive is silent")
        self.order(Stop())
        self.look("stopping a silent drive")
        site.do(site.served.drives["T1"].end_injected_faults)
        site.until(lambda: site.tracker.unreachable is None)
        self.look("the drive is back")


def opened(site: SiteStage, path: str, *kinds: tuple[str, str]) -> Walk:
    return Walk(
        site, {f"{size} {language}": site.open(path, size, language=language) for size, language in kinds}
    )


def test_on_homing_the_buttons_stay_where_they_are(site: SiteStage) -> None:
    found = opened(site, HOMING, ("tablet", "en"), ("tablet", "de"), ("phone", "en"), ("phone", "de"))
    found.look("idle, not homed")
    found.jog()
    found.meet_a_limit()
    site.beat_ms = COARSE_MS
    found.set_home()
    found.meet_a_storm()
    assert found.moved == {}, found.places


def test_on_the_page_for_the_phone_they_stay_too(site: SiteStage) -> None:
    found = opened(site, MAST, ("phone", "en"), ("phone", "de"))
    found.look("idle, not homed")
    found.jog()
    site.beat_ms = COARSE_MS
    found.set_home()
    found.meet_a_storm()
    assert found.moved == {}, found.places
