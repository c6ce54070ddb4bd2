"""A form whose order is refused stays as it was typed, and the refusal stands in it: see errors.js."""

from playwright.sync_api import Page, expect

from app.tracker.values.reason import Reason
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import confirm

T1 = "/trackers/T1"
LOCATION = f"{T1}/commissioning/location"
TRACKS = Reason(
    "follows_the_sun", "T1 is tracking the sun for the present location.", "End tracking of T1 first."
)
NOISE = ("Failed to load resource", "htmx:error")


def typed(opened: Opened) -> Page:
    page = opened(LOCATION, "tablet", still=True, allow=NOISE)
    page.locator("#f-latitude").fill("32.4846")
    page.locator("#f-longitude").fill("37.8716")
    page.locator("#forward .key").click()
    return page


def expect_refused(page: Page, what: str) -> None:
    told = page.locator("#step-form .outcome-refused")
    expect(told).to_contain_text(what)
    expect(told).to_be_in_viewport()
    expect(page.locator("#f-latitude")).to_have_value("32.4846")
    expect(page.locator("#f-longitude")).to_have_value("37.8716")
    expect(page.locator("#forward .key")).to_be_enabled()


def test_a_location_is_refused_while_tracking_before_it_is_asked_about(opened: Opened) -> None:
    page = typed(opened)
    expect_refused(page, "End tracking of T2 first.")
    expect(page.locator("#place-doubts > .question")).to_have_count(0)


def test_a_location_that_is_refused_after_the_question_keeps_the_form(opened: Opened, plant: Plant) -> None:
    plant.machine.rest()
    plant.machine.rejects = {"set_location": (TRACKS,)}
    page = typed(opened)
    confirm(page, page.locator("[name=sun_there]"), page.clock.run_for)
    expect_refused(page, "End tracking of T1 first.")
    expect(page.locator("#place-doubts > .question")).to_be_hidden()
