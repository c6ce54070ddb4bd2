"""Each of the five steps is one view: nothing scrolls on a tablet, no button lies below the fold of a phone.

`make looks` holds every language against it; here are the two with the shortest and with long words.
"""

import asyncio

import pytest
from playwright.sync_api import Page, expect

from app.link.messages import Order
from app.tracker.commands.commands import SelectMode
from app.tracker.values.mode import Mode
from tests.browser.conftest import Opened, Plant, resize
from tests.browser.layout import faults, step_faults

STEPS = "/trackers/T1/commissioning"
SLOTS = """() => [...document.querySelectorAll('.slots-steps > :is(.slot, .slot-back)')]
  .map((one) => Math.round(one.getBoundingClientRect().top))"""
PLACES = [60, 184, 308, 432]
"""Where the actions of a step begin on a tablet, pixels; each has its meaning by its place."""


def wrong(page: Page) -> list[str]:
    found = []
    for size in ("tablet", "phone"):
        resize(page, size)
        found += [f"{size}: {one}" for one in step_faults(page) + faults(page)]
    return found


@pytest.mark.parametrize("language", ["en", "de"])
def test_no_step_scrolls_and_every_action_has_its_place(plant: Plant, opened: Opened, language: str) -> None:
    page = opened("/account", "tablet")
    page.context.add_cookies([{"name": "language", "value": language, "url": plant.url}])
    for step in ("location", "clock", "homing", "mode", "run"):
        resize(page, "tablet")
        page.goto(f"{plant.url}{STEPS}/{step}")
        page.wait_for_selector("html[data-link=live]")
        assert page.evaluate(SLOTS) == PLACES, step
        assert wrong(page) == [], step


def test_what_a_mode_holds_is_set_in_one_view(plant: Plant, opened: Opened) -> None:
    order = Order(SelectMode(Mode.FIXED), "ada", "T1", via="session", rank=2)
    plant.do(lambda: asyncio.ensure_future(plant.machine.execute(order)))
    page = opened(f"{STEPS}/mode/orientation", "tablet")
    page.wait_for_selector("html[data-link=live]")
    expect(page.locator(".slot-1 .key")).to_be_visible()
    assert wrong(page) == []
