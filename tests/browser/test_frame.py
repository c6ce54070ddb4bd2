"""The frame: how much of a screen it leaves to the page, where STOP is, what stays, what never moves."""

from typing import Any

from playwright.sync_api import Browser, Page, expect

from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES, Opened, Plant, go, now, resize
from tests.browser.troubles import trouble

LEAST_SHARE, LEAST_HEIGHT = 0.72, 0.84
LONGEST = max(LANGUAGES, key=lambda code: len(catalogue_of(code).gettext("Set home here")))
HOMING = "/trackers/T1/commissioning/homing"
T3 = "/trackers/T3"
LINK_ERRORS = ("WebSocket", "Failed to load resource", "WebGL")
SEEN = """([across, down]) => {
  const seen = (x, y) => {
    const there = document.elementFromPoint(x, y);
    const isAction = there?.closest(".slot-1, .slot-2");
    const inFrame = !isAction && there?.closest(".rail, .footer, .messages:has(> [open]), .stop-answer");
    return !inFrame && y >= document.querySelector(".header").getBoundingClientRect().bottom;
  };
  const steps = (length, most) => [...Array(length)].map((_, step) => (step + 0.5) * most / length);
  const free = (y) => steps(across, innerWidth).filter((x) => seen(x, y)).length / across;
  const rows = steps(down, innerHeight).map(free);
  return [rows.reduce((sum, row) => sum + row, 0) / down, rows.filter((row) => row > 0.99).length / down];
}"""
"""The share of the screen, and of its height, at which the page and its actions are seen, not the frame."""
STOP_AND_ACTION = """() => {
  const [stop, action, header] = ["#stop-key", "#forward .key", ".header"]
    .map((one) => document.querySelector(one).getBoundingClientRect());
  const there = document.elementFromPoint(stop.x + stop.width / 2, stop.y + stop.height / 2);
  return [stop.toJSON(), action.toJSON(), header.top, there.closest("#stop-key") !== null];
}"""
HELD = "[data-jog], #stop-key, #forward .key, #alarm-strip, .control > summary"
BOXES = """names => [...document.querySelectorAll(names)].map((one) => {
  const { right, top, bottom } = one.getBoundingClientRect();
  return [right, top, bottom];
})"""


ALL_MESSAGES = """names => {
  const boxes = %s;
  const messages = document.querySelectorAll(".messages > .banner:not(.link-banner)");
  for (const one of messages) one.hidden = false;
  document.querySelector(".says-first").textContent = "Drive does not answer ".repeat(9);
  document.getElementById("says").dataset.priority = "1";
  const covered = getComputedStyle(document.getElementById("says")).visibility !== "visible";
  const seen = document.getElementById("outdated-banner").checkVisibility() && !covered;
  const shown = boxes(names);
  document.querySelector(".messages > .pop > summary").click();
  document.getElementById("says").open = true;
  return [shown, boxes(names), seen];
}"""
"""In one turn of the page: its next look at the tracker hides again what is not so."""


def in_language(page: Page, plant: Plant, language: str, path: str) -> None:
    page.context.add_cookies([{"name": "language", "value": language, "url": plant.url}])
    go(page, plant.url + path)


def expect_most_of_the_screen(page: Page) -> None:
    for size in ("phone", "tablet"):
        resize(page, size)
        share, height = page.evaluate(SEEN, [24, 106])
        assert share >= LEAST_SHARE, (size, page.url)
        assert size == "tablet" or height >= LEAST_HEIGHT, page.url


def test_the_page_has_most_of_the_screen_with_messages_shown(plant: Plant, opened: Opened) -> None:
    now(plant, lambda: trouble(plant.machine))
    page = opened("/account", allow=LINK_ERRORS)
    for language, path in (("en", f"{T3}/commissioning/homing"), ("de", "/")):
        in_language(page, plant, language, path)
        expect(page.locator('#says[data-priority="1"]')).to_be_visible()
        expect_most_of_the_screen(page)
    plant.do(plant.machine.cut)
    page.wait_for_selector("#link-banner:visible")
    expect_most_of_the_screen(page)


def test_stop_and_the_action_are_at_the_same_pixel_whatever_is_written(plant: Plant, opened: Opened) -> None:
    page = opened("/account", allow=LINK_ERRORS)
    places: dict[str, set[Any]] = {size: set() for size in SIZES}
    for language in ("en", LONGEST):
        in_language(page, plant, language, HOMING)
        for size, found in places.items():
            resize(page, size)
            page.evaluate("scrollTo(0, 1e6)")
            stop, action, top, seen = page.evaluate(STOP_AND_ACTION)
            assert seen, "nothing is upon STOP"
            assert top == 0, "the bar stays"
            assert action["height"] >= 64
            across = () if size == "phone" else (stop["x"], action["x"])
            found.add((stop["y"], stop["height"], action["y"], *across))
    assert {size: len(found) for size, found in places.items()} == dict.fromkeys(SIZES, 1)


def test_messages_that_come_and_go_move_nothing(plant: Plant, opened: Opened) -> None:
    for size in ("tablet", "phone"):
        page = opened(HOMING, size, allow=LINK_ERRORS)
        before = page.evaluate(BOXES, HELD)
        assert len(before) == 8
        shown, opened_too, seen = page.evaluate(ALL_MESSAGES % BOXES, HELD)
        assert seen
        assert shown == before
        assert opened_too == before
        expect(page.get_by_role("button", name="Reload page")).to_be_visible()


def test_the_rail_of_the_site_leads_to_the_tracker_that_was_looked_at_last(opened: Opened) -> None:
    page = opened("/trackers/T2/settings", "tablet")
    page.locator(".rail-pages a").first.click()
    expect(page.locator(".rail-pages a").nth(1)).to_have_attribute("href", "/trackers/T2")


def test_every_place_is_reached_without_javascript(plant: Plant, browser: Browser) -> None:
    plain = browser.new_context(java_script_enabled=False)
    page = plain.new_page()
    for size in ("tablet", "phone"):
        width, height = SIZES[size]
        page.set_viewport_size({"width": width, "height": height})
        page.goto(plant.url + "/trackers/T1")
        if size == "phone":
            page.locator(".menu-key").click()
        page.locator(".more > summary").click()
        page.get_by_role("link", name="Journal").click()
        page.wait_for_url("**/journal")
    plain.close()


def test_a_phone_searches_from_its_menu(opened: Opened) -> None:
    for size, is_in_menu in (("tablet", False), ("phone", True)):
        page = opened(HOMING, size)
        search = page.locator(".rail-search")
        expect(search).to_be_hidden()
        expect(page.locator(".header-search")).to_be_visible(visible=not is_in_menu)
    page.locator(".menu-key").click()
    expect(search).to_be_in_viewport(ratio=1)
    search.click()
    page.wait_for_url("**/search")
    expect(page.locator("input[type=search], input[name=q]").first).to_be_in_viewport()
