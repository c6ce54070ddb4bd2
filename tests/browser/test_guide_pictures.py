"""The five steps as the operator's guide shows them, on the real service.

With `HELIOPANEL_DOCS=1` this test, and others, take the pictures that `GUIDE` of `conftest.py` names anew.
"""

from datetime import UTC, datetime

from playwright.sync_api import expect

from tests.browser.conftest import GUIDE, PICTURES
from tests.browser.hands import LINK_MEASURED, Mouse, middle
from tests.browser.walking import Picture, Walker, onwards, rooms, service, set_home, trust_the_clock, walker
from tests.e2e.chromium import PAGE_READY

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
