"""Pictures of the operator's guide for which the real service is needed; the gate does not collect this file.

    HELIOPANEL_DOCS=1 pytest tests/browser/guide_pictures.py tests/browser/test_access.py

takes all pictures that `GUIDE` of `conftest.py` names.
"""

import re
from datetime import UTC, datetime

from playwright.sync_api import Locator, Page, expect

from tests.browser.conftest import GUIDE, PICTURES
from tests.browser.hands import LINK_MEASURED, arrive, middle
from tests.browser.walking import Picture, Walker, rooms, service, walker
from tests.e2e.chromium import PAGE_READY
from tests.e2e.integrator import Integrator

__all__ = ["rooms", "service", "walker"]
TOWNS = ((41.2867, 36.33), (39.7392, -104.9903), (-33.8688, 151.2093), (21.3069, -157.8583))
"""Samsun, Denver, Sydney and Honolulu: a picture is taken where the sun is up."""


def town_by_day() -> tuple[float, float]:
    """Return latitude and longitude of the town where noon is nearest."""
    noon_deg = 15.0 * (12 - datetime.now(UTC).hour)
    return min(TOWNS, key=lambda town: abs((town[1] - noon_deg + 180.0) % 360.0 - 180.0))


def onwards(page: Page, to: str) -> None:
    page.locator("#forward .key").click()
    arrive(page, to)


def hold(page: Page, key: Locator) -> None:
    """Hold a key until it counts, which is when the page sends its order."""
    expect(key).to_be_enabled()
    page.mouse.move(*middle(key))
    with page.expect_response(lambda answer: answer.request.method == "POST"):
        page.mouse.down()
    page.mouse.up()


def test_the_five_steps_are_pictured(walker: Walker, service: str, picture: Picture) -> None:
    page = walker("tablet", "mouse")
    latitude, longitude = town_by_day()
    page.goto(f"{service}/trackers/T1/commissioning/location")
    page.wait_for_selector(PAGE_READY)
    page.locator(f'[name="latitude_side"][value="{"N" if latitude >= 0 else "S"}"]').check()
    page.locator(f'[name="longitude_side"][value="{"E" if longitude >= 0 else "W"}"]').check()
    page.locator("#f-latitude").fill(str(abs(latitude)))
    page.locator("#f-longitude").fill(str(abs(longitude)))
    expect(page.locator("#larger")).to_contain_text("/")
    picture(page, "step-location")
    page.locator("#forward .key").click()
    page.wait_for_selector("#place-doubts > .question, #clock-apart")
    sure = page.locator('#place-doubts [name="sun_there"]')
    if sure.count():
        hold(page, sure)
        page.wait_for_selector("#clock-apart")
    expect(page.locator("#clock-apart")).to_contain_text("0 s")
    picture(page, "step-clock")
    onwards(page, "/homing")
    page.wait_for_selector(LINK_MEASURED)
    key = page.locator('[data-jog="azimuth"][data-direction="-1"]')
    page.mouse.move(*middle(key))
    page.mouse.down()
    page.wait_for_selector('[data-jog="azimuth"][data-held]')
    expect(page.locator(".says-state")).to_contain_text("Jogging")
    picture(page, "step-homing")
    page.mouse.up()
    expect(page.locator(".says-state")).not_to_contain_text("Jogging")
    hold(page, page.locator('[data-action="set_home"]').first)
    hold(page, page.locator('[name="confirmed"]'))
    page.wait_for_selector("#forward a.key")
    onwards(page, "/mode")
    picture(page, "step-mode")
    page.locator('input[value="dual"]').check()
    onwards(page, "/run")
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
    ready(service)
    page.goto(f"{service}/trackers/T1/show")
    page.get_by_role("link", name="21 June").click()
    page.locator("#f-minutes").fill("0.2")
    expect(page.locator("#verdict:not([inert])")).to_contain_text("cannot be run")
    page.locator("#verdict a.key-primary").click()
    expect(page.locator("#verdict")).to_contain_text("This works")
    page.locator('[data-action="go_to_start"]').click()
    arrive(page, "/shows/.*")
    expect(page.locator("#show-phase")).to_have_text("Ready at the start")
    page.locator('[data-action="run_show"]').click()
    expect(page.locator("#show-phase")).to_have_text("Running")
    progressed(page, "#show-progress", 0.02)
    picture(page, "show-on-the-machine")
    page.locator('[data-action="pause_show"]').click()
    expect(page.locator("#show-phase")).to_have_text("Paused")
    page.locator('[data-action="stop_show"]').click()
    expect(page.locator("#show-phase")).to_have_text("Ended")
    page.get_by_role("link", name="Replay").click()
    expect(page.locator("h1")).to_have_text(re.compile("Replay: Show of .*-06-21"))
    expect(page.locator("#player-state")).to_have_text("")
    page.locator("#player-play").click()
    progressed(page, "#player-scrubber", 1.0)
    picture(page, "replay")
