"""Pictures of the operator's guide for which the real service is needed; the gate does not collect this file.

    HELIOPANEL_DOCS=1 pytest tests/browser/guide_pictures.py tests/browser/test_access.py

takes all pictures that `GUIDE` of `conftest.py` names.
"""

import re
from datetime import UTC, datetime

from playwright.sync_api import Page, expect

from tests.browser.conftest import GUIDE, PICTURES
from tests.browser.hands import LINK_MEASURED, Mouse, arrive, middle
from tests.browser.walking import (
    Picture,
    Walker,
    onwards,
    rooms,
    service,
    set_home,
    trust_the_clock,
    walker,
)
from tests.e2e.chromium import PAGE_READY
from tests.e2e.integrator import Integrator

__all__ = ["rooms", "service", "walker"]
TOWNS = ((41.2867, 36.33), (39.7392, -104.9903), (-33.8688, 151.2093), (21.3069, -157.8583))
"""Samsun, Denver, Sydney and Honolulu: a picture is taken where the sun is up."""


def town_by_day() -> tuple[float, float]:
    """Return latitude and longitude of the town where noon is nearest."""
    noon_deg = 15.0 * (12 - datetime.now(UTC).hour)
    return min(TOWNS, key=lambda town: abs((town[1] - noon_deg + 180.0) % 360.0 - 180.0))


def test_the_five_steps_are_pictured(walker: Walker, service: str, picture: Picture) -> None:
    page = walker("tablet", "mouse")
    hands = Mouse(page)
    latitude, longitude = town_by_day()
    page.goto(f"{service}/trackers/T1/commissioning/location")
    page.wait_for_selector(PAGE_READY)
    hands.choose(page.locator(f'[name="latitude_side"][value="{"N" if latitude >= 0 else "S"}"]'))
    hands.choose(page.locator(f'[name="longitude_side"][value="{"E" if longitude >= 0 else "W"}"]'))
    hands.write(page.locator("#f-latitude"), str(abs(latitude)))
    hands.write(page.locator("#f-longitude"), str(abs(longitude)))
    expect(page.locator("#preview")).to_contain_text("/")
    picture(page, "step-location")
    hands.press(page.locator("#forward .key"))
    sure = page.locator('#place-doubts [name="sun_there"]')
    page.wait_for_selector("#place-doubts, #clock-apart")
    if sure.count():
        hands.choose(sure)
        onwards(page, hands, "/clock")
    expect(page.locator("#clock-apart")).to_contain_text("0 s")
    picture(page, "step-clock")
    trust_the_clock(page, hands)
    page.wait_for_selector(LINK_MEASURED)
    key = page.locator('[data-jog="azimuth"][data-direction="-1"]')
    page.mouse.move(*middle(key))
    page.mouse.down()
    page.wait_for_selector('[data-jog="azimuth"][data-held]')
    expect(page.locator(".strip-activity")).to_contain_text("Jogging")
    picture(page, "step-homing")
    page.mouse.up()
    expect(page.locator(".strip-activity")).to_contain_text("Holding")
    set_home(page, hands)
    page.wait_for_selector("#forward a.key")
    onwards(page, hands, "/mode")
    picture(page, "step-mode")
    hands.choose(page.locator('input[value="dual"]'))
    onwards(page, hands, "/run")
    page.locator(".scene").scroll_into_view_if_needed()
    page.wait_for_selector('.scene[data-painter="webgl2"][data-frames]')
    page.evaluate("scrollTo(0, 0)")
    picture(page, "step-run")


def test_every_picture_that_is_taken_is_one_of_the_guide() -> None:
    guide = (PICTURES.parent / "operate" / "operators-guide.md").read_text()
    assert [name for name in GUIDE.values() if f"(../pictures/{name}.png)" not in guide] == []


def ready(service: str) -> None:
    """Bring the tracker to where a show can be planned: placed, zeroed, its clock trusted."""
    calling = Integrator(service)
    calling.place_and_time()
    calling.zero()
    calling.command("set_mode", mode="dual")
    calling.close()


def progressed(page: Page, bar: str, beyond: float) -> None:
    """Return once a bar of the page is beyond a value."""
    shown = page.locator(bar)
    while float(shown.evaluate("bar => bar.value")) <= beyond:
        page.evaluate("new Promise((done) => requestAnimationFrame(done))")


def test_solstice_is_shown_and_replayed(walker: Walker, service: str, picture: Picture) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    ready(service)
    page.goto(f"{service}/trackers/T1/show")
    hands.press(page.get_by_role("link", name="21 June"))
    hands.write(page.locator("#f-minutes"), "0.2")
    expect(page.locator("#verdict:not([inert])")).to_contain_text("cannot be run")
    hands.press(page.locator("#verdict a.key-primary"))
    expect(page.locator("#verdict")).to_contain_text("This works")
    hands.press(page.locator('[data-action="go_to_start"]'))
    arrive(page, "/shows/.*")
    expect(page.locator("#show-phase")).to_have_text("Ready at the start")
    hands.press(page.locator('[data-action="run_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Running")
    progressed(page, "#show-progress", 0.02)
    picture(page, "show-on-the-machine")
    hands.press(page.locator('[data-action="pause_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Paused")
    hands.press(page.locator('[data-action="stop_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Ended")
    hands.press(page.get_by_role("link", name="Replay"))
    expect(page.locator("h1")).to_have_text(re.compile("Replay: Show of .*-06-21"))
    expect(page.locator("#player-state")).to_have_text("")
    hands.press(page.locator("#player-play"))
    progressed(page, "#player-scrubber", 1.0)
    picture(page, "replay")
