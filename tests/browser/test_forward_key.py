"""The key forward works whatever else is under way: the step bar is renewed, an order is not answered yet."""

from playwright.sync_api import Route, expect

from tests.browser.conftest import Opened, Plant
from tests.browser.hands import arrive, middle
from tests.browser.page_clock import Stage
from tests.e2e.chromium import PAGE_READY

LOCATION = "/trackers/T1/commissioning/location"
PROGRESS = "/trackers/T1/commissioning/progress/location?here=/trackers/T1/commissioning/location"
RENEWED = f"""() => new Promise((resolve) => {{
  document.addEventListener("htmx:finally:request", () => {{
    requestAnimationFrame(() => requestAnimationFrame(resolve));
  }}, {{ once: true }});
  window.htmx.ajax("GET", "{PROGRESS}", {{ swap: "none" }});
}})"""


ANSWERED = """() => document.addEventListener("htmx:finally:request", () => {
  setTimeout(() => console.debug("answered"));
})"""


def test_a_press_outlives_the_renewal_of_the_step_bar(plant: Plant, opened: Opened) -> None:
    page = opened(LOCATION)
    expect(page.locator("#forward .key")).to_be_enabled()
    page.locator("#forward .key").hover()
    page.mouse.down()
    page.evaluate(RENEWED)
    page.mouse.up()
    arrive(page, "/commissioning/clock")
    assert len(plant.orders("set_location")) == 1


def test_an_answer_that_comes_late_brings_nobody_back(plant: Plant, opened: Opened) -> None:
    page = opened("/trackers/T1/commissioning/clock")
    order: list[Route] = []
    going: list[Route] = []
    page.route("**/commissioning/clock", lambda route: order.append(route))
    page.route("**/commissioning/mode", lambda route: going.append(route))
    page.evaluate(ANSWERED)
    with page.expect_request("**/commissioning/clock"):
        page.locator("#forward .key").click()
    with page.expect_request("**/commissioning/mode"):
        page.locator('.step-link[href$="/commissioning/mode"]').click(no_wait_after=True)
    with page.expect_console_message(lambda said: said.text == "answered"):
        order[0].continue_()
    going[0].continue_()
    arrive(page, "/commissioning/mode")


def test_a_second_tap_saves_nothing_on_a_page_that_was_not_seen(stage: Stage) -> None:
    page = stage.open(LOCATION, "tablet")
    for step in ("clock", "mode"):
        page.goto(f"{stage.plant.url}/trackers/T1/commissioning/{step}")
        page.wait_for_selector(PAGE_READY)
        save = page.locator("#forward .key")
        assert save.is_disabled()
        stage.advance(600)
        page.mouse.click(*middle(save))
        stage.advance(50)
        assert save.is_disabled()
        stage.advance(100)
        assert save.is_enabled()
    assert stage.plant.machine.orders == []
