"""The frame: how much of a screen it leaves to the page, where STOP is, what stays, what never moves."""

from dataclasses import replace
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.web.languages.known import LANGUAGES
from tests.browser.conftest import SIZES, Opened, Plant
from tests.browser.layout import page_end
from tests.browser.test_languages_fit import ON_ANOTHER
from tests.browser.troubles import trouble
from tests.e2e.chromium import PAGE_READY

LEAST_SHARE, LEAST_HEIGHT = 0.72, 0.84
SITE = "Konya Karapınar Solar Park 2"
TRACKER = "Northwest corner mast"
HOMING = "/trackers/T1/commissioning/homing"
PATHS = ("/", "/simulate", "/trackers/T1", HOMING, "/trackers/T1/protections")
TROUBLED = ("/", "/trackers/T3", "/trackers/T3/commissioning/homing")
LINK_ERRORS = ("WebSocket", "Failed to load resource", "WebGL")
SEEN = """([across, down]) => {
  const seen = (x, y) => {
    const there = document.elementFromPoint(x, y);
    const inFrame = there?.closest(".rail, .footer, .messages:has(> [open]), .stop-answer");
    return !inFrame && y >= document.querySelector(".header").getBoundingClientRect().bottom;
  };
  const steps = (length, most) => [...Array(length)].map((_, step) => (step + 0.5) * most / length);
  const free = (y) => steps(across, innerWidth).filter((x) => seen(x, y)).length / across;
  const rows = steps(down, innerHeight).map(free);
  return [rows.reduce((sum, row) => sum + row, 0) / down, rows.filter((row) => row > 0.99).length / down];
}"""
"""The share of the screen, and of its height, at which the page is seen and nothing of the frame."""
CUT = """() => {
  const header = document.querySelector(".header").getBoundingClientRect();
  const shown = [...document.querySelectorAll(".header-where > b")];
  return shown.filter((one) => {
    const box = one.getBoundingClientRect();
    const across = box.left >= 0 && box.right <= innerWidth;
    const within = across && box.top >= header.top && box.bottom <= header.bottom;
    return !within || one.scrollWidth > one.clientWidth + 1 || one.scrollHeight > one.clientHeight + 1;
  }).map((one) => one.textContent);
}"""
BROKEN = """() => {
  const text = document.querySelector(".header-where b").firstChild;
  return [...text.data.matchAll(/[^\\s-]+/g)].filter((word) => {
    const range = document.createRange();
    range.setStart(text, word.index);
    range.setEnd(text, word.index + word[0].length);
    return range.getClientRects().length > 1;
  }).map((word) => word[0]);
}"""
OVER = """() => {
  const parts = [...document.querySelectorAll(".header > *")].filter((one) => one.checkVisibility());
  const boxes = parts.map((one) => one.getBoundingClientRect());
  return boxes.flatMap((one, index) => boxes.slice(index + 1).map((two, more) => {
    const across = Math.min(one.right, two.right) - Math.max(one.left, two.left);
    const down = Math.min(one.bottom, two.bottom) - Math.max(one.top, two.top);
    return across > 0.5 && down > 0.5 ? [parts[index].className, parts[index + 1 + more].className] : null;
  })).filter(Boolean);
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
  document.querySelector(".alarm-first-words b").textContent = "Drive does not answer";
  const seen = document.querySelector("[data-when=warning]").checkVisibility();
  const shown = boxes(names);
  document.querySelector(".messages > .pop > summary").click();
  return [shown, boxes(names), seen];
}"""
"""In one turn of the page: its next look at the tracker hides again what is not so."""


def in_language(page: Page, plant: Plant, language: str, path: str) -> None:
    page.context.add_cookies([{"name": "language", "value": language, "url": plant.url}])
    page.goto(plant.url + path)
    page.wait_for_selector(PAGE_READY)


def shares(page: Page) -> tuple[float, float]:
    share, height = page.evaluate(SEEN, [64, 211])
    return share, height


def name_them(plant: Plant) -> None:
    plant.machine.site = replace(plant.machine.site, name=SITE)
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, name=TRACKER)


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_the_page_has_most_of_the_screen_with_messages_shown(size: str, plant: Plant, opened: Opened) -> None:
    plant.do(lambda: trouble(plant.machine))
    page = opened("/trackers/T3", size, allow=LINK_ERRORS)
    for language in LANGUAGES:
        for path in TROUBLED:
            in_language(page, plant, language, path)
            expect(page.locator(".messages > .banner:not([hidden])").first).to_be_visible()
            share, height = shares(page)
            assert share >= LEAST_SHARE, (language, path)
            assert size == "tablet" or height >= LEAST_HEIGHT, (language, path)
    plant.do(plant.machine.cut)
    page.wait_for_selector("#link-banner:visible")
    share, height = shares(page)
    assert share >= LEAST_SHARE
    assert size == "tablet" or height >= LEAST_HEIGHT


@pytest.mark.parametrize("size", ["tablet", "phone", "desk"])
def test_stop_and_the_action_are_at_the_same_pixel_in_every_language(
    size: str, plant: Plant, opened: Opened
) -> None:
    page = opened(HOMING, size)
    places: set[Any] = set()
    for language in LANGUAGES:
        in_language(page, plant, language, HOMING)
        page.evaluate("scrollTo(0, 1e6)")
        stop = page.locator("#stop-key").bounding_box()
        assert stop is not None
        assert page.evaluate(
            "([x, y]) => document.elementFromPoint(x, y).closest('#stop-key') !== null",
            [stop["x"] + stop["width"] / 2, stop["y"] + stop["height"] / 2],
        )
        action = page.locator("#forward .key").bounding_box()
        assert action is not None
        assert action["height"] >= 64
        places.add(
            (stop["y"], stop["height"], action["y"], *([] if size == "phone" else [stop["x"], action["x"]]))
        )
        assert page.locator(".header").evaluate("one => one.getBoundingClientRect().top") == 0, (
            "the bar stays"
        )
    assert len(places) == 1


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_messages_that_come_and_go_move_nothing(size: str, plant: Plant, opened: Opened) -> None:
    page = opened(HOMING, size, allow=LINK_ERRORS)
    before = page.evaluate(BOXES, HELD)
    assert len(before) == 8
    shown, opened_too, seen = page.evaluate(ALL_MESSAGES % BOXES, HELD)
    assert seen
    assert shown == before
    assert opened_too == before
    expect(page.get_by_role("button", name="Reload page")).to_be_visible()
    page.keyboard.press("Escape")


def test_names_in_the_bar_of_a_phone_are_whole(plant: Plant, opened: Opened) -> None:
    name_them(plant)
    page = opened("/", "phone")
    for language in LANGUAGES:
        for path in PATHS:
            in_language(page, plant, language, path)
            name = page.locator(".header-where b").inner_text()
            assert (TRACKER if "T1" in path else SITE) in name
            seen = f"{path} in {language}"
            assert page.evaluate(CUT) == [], seen
            assert language == "zh_Hans" or page.evaluate(BROKEN) == [], seen
            assert page.evaluate(OVER) == [], seen
            assert page.evaluate(ON_ANOTHER) == [], seen


def test_the_rail_of_the_site_leads_to_the_tracker_that_was_looked_at_last(opened: Opened) -> None:
    page = opened("/trackers/T2", "tablet")
    page.locator(".rail-pages a").first.click()
    page.wait_for_selector(PAGE_READY)
    assert page.locator(".rail-pages a").nth(1).get_attribute("href") == "/trackers/T2"


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_every_place_is_reached_without_javascript(size: str, plant: Plant, opened: Opened) -> None:
    browser = opened("/").context.browser
    assert browser is not None
    width, height = SIZES[size]
    plain = browser.new_context(java_script_enabled=False, viewport={"width": width, "height": height})
    page = plain.new_page()
    page.goto(plant.url + "/trackers/T1")
    if size == "phone":
        page.locator(".menu-key").click()
    page.locator(".more > summary").click()
    page.get_by_role("link", name="Journal").click()
    assert page.url.endswith("/journal")
    plain.close()


def test_the_end_of_the_page_is_above_the_bar_below_on_a_phone(opened: Opened) -> None:
    assert page_end(opened("/", "tablet")) == SIZES["tablet"][1]
    assert page_end(opened("/", "phone")) == SIZES["phone"][1] - 72
