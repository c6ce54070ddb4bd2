"""Sixty trackers in a storm: those in danger first in every layout, alone when tapped, stowed in two taps."""

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.conftest import Opened, Plant, now
from tests.browser.storm import IN_DANGER, STOWING, endanger, sixty_in_a_storm, stow
from tests.e2e.chromium import PAGE_READY
from tests.patience import until

FOUR = ["T5", *IN_DANGER]
ORDER = "list => [...list.children].filter((one) => !one.hidden).map((one) => one.dataset.item)"
IN_SIGHT = "one => one.getBoundingClientRect().top < innerHeight && one.getBoundingClientRect().top > 0"
JUST_CHANGED_MS, CLICKS_WITHIN_MS = 700, 500
"""So long a press is not for what has just changed, and nothing changes after a finger is lifted."""


@pytest.fixture
def storm(plant: Plant) -> Plant:
    now(plant, lambda: sixty_in_a_storm(plant.machine))
    return plant


def order(page: Page) -> list[str]:
    return list(page.locator("#trackers").evaluate(ORDER))


def count(page: Page, state: str) -> Locator:
    return page.locator(f'.count[data-state="{state}"]')


def stowed(plant: Plant) -> list[str | None]:
    return [one.tracker_id for one in list(plant.machine.orders) if one.command.kind == "stow"]


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_from_the_first_page_to_stow_of_the_most_urgent_it_is_one_tap(
    size: str, storm: Plant, opened: Opened
) -> None:
    page = opened("/", size)
    key = page.get_by_role("button", name="Stow T31")
    assert key.evaluate(IN_SIGHT)
    key.click()
    until(lambda: stowed(storm) == ["T31"], "the order arrives")
    assert [(one.position, one.kind) for one in storm.orders("stow")] == [("wind", "stow")]


@pytest.mark.parametrize("layout", ["tiles", "rows"])
def test_from_the_first_page_to_stow_of_each_in_danger_it_is_two_taps(
    layout: str, storm: Plant, opened: Opened
) -> None:
    for name in IN_DANGER:
        page = opened(f"/?layout={layout}", "tablet")
        assert order(page)[:3] == list(IN_DANGER)
        entry = page.locator(f'[data-item="{name}"]')
        assert entry.evaluate(IN_SIGHT), "it is seen without scrolling"
        entry.locator("a").first.click()
        expect(page).to_have_url(f"{storm.url}/trackers/{name}")
        page.wait_for_selector(PAGE_READY)
        page.locator(f'form[action="/trackers/{name}/stow"] button:visible').first.click()
        until(lambda: stowed(storm)[-1:] == [name], "the order arrives")  # noqa: B023 - waited for here
    assert stowed(storm) == list(IN_DANGER)


def test_a_tracker_that_becomes_urgent_comes_first_at_once(storm: Plant, opened: Opened) -> None:
    page = opened("/", "tablet")
    assert order(page)[:5] == [*IN_DANGER, *STOWING]
    storm.do(lambda: endanger(storm.machine, "T5"))
    expect(page.locator("#trackers > li").first).to_have_attribute("data-item", "T5")
    assert order(page)[:6] == [*FOUR, *STOWING], "equals stay as the site has them"
    expect(count(page, "not_stowed").locator("b")).to_have_text("4")
    expect(count(page, "stowed").locator("b")).to_have_text("54")
    expect(page.locator(".count-all b")).to_have_text("60")


def test_nothing_moves_under_a_finger(storm: Plant, opened: Opened) -> None:
    page = opened("/", "tablet")
    page.locator("#site-urgent h2").hover()
    page.mouse.down()
    storm.do(lambda: (endanger(storm.machine, "T5"), stow(storm.machine, "T31")))
    expect(count(page, "stowed").locator("b")).to_have_text("55")
    expect(page.locator('[data-tile="T5"]')).to_have_attribute("data-priority", "1")
    assert order(page)[:3] == list(IN_DANGER)
    expect(page.locator("#site-urgent h2")).to_contain_text("T31")
    page.mouse.up()
    expect(page.locator("#site-urgent h2")).to_contain_text("T5")
    assert order(page)[:3] == ["T5", "T47", "T52"]


def test_while_the_focus_is_in_the_list_only_danger_moves_it_and_the_focus_stays(
    storm: Plant, opened: Opened
) -> None:
    page = opened("/", "tablet")
    page.locator('[data-tile="T47"]').focus()
    storm.do(lambda: stow(storm.machine, "T12"))
    expect(count(page, "stowing").locator("b")).to_have_text("1")
    assert order(page)[:5] == [*IN_DANGER, *STOWING]
    storm.do(lambda: endanger(storm.machine, "T5"))
    expect(page.locator("#trackers > li").first).to_have_attribute("data-item", "T5")
    expect(page.locator('[data-tile="T47"]')).to_be_focused()
    assert order(page)[:5] == [*FOUR, "T44"]


def test_a_count_shows_its_trackers_alone_until_it_is_tapped_again(storm: Plant, opened: Opened) -> None:
    page = opened("/", "phone")
    count(page, "stowing").click()
    expect(count(page, "stowing")).to_have_attribute("aria-pressed", "true")
    expect(page).to_have_url(f"{storm.url}/?state=stowing")
    assert order(page) == list(STOWING)
    page.reload()
    expect(count(page, "stowing")).to_have_attribute("aria-pressed", "true")
    assert order(page) == list(STOWING)
    page.wait_for_selector(PAGE_READY)
    storm.do(lambda: stow(storm.machine, "T12"))
    expect(page.locator('[data-item="T12"]')).to_be_hidden()
    storm.do(lambda: stow(storm.machine, "T44"))
    expect(page.locator("#none-alike")).to_be_visible()
    expect(count(page, "stowing").locator("b")).to_have_text("0")
    count(page, "stowing").click()
    expect(page).to_have_url(f"{storm.url}/")
    expect(page.locator("#none-alike")).to_be_hidden()
    expect(count(page, "stowing")).to_be_hidden()
    assert len(order(page)) == 60
    page.locator("#urgent-more").click()
    assert order(page) == list(IN_DANGER)
    page.locator(".count-all").click()
    assert len(order(page)) == 60


def test_a_press_where_something_else_has_just_stood_stows_nothing(storm: Plant, opened: Opened) -> None:
    page = opened("/", "tablet", still=True)
    page.evaluate("document.getElementById('counts').style.minHeight = '300px'")
    stow_it = page.get_by_role("button", name="Stow T31")
    stow_it.click()
    expect(page.locator("#site-urgent .outcome")).to_contain_text("has just changed")
    assert stowed(storm) == []
    page.clock.run_for(JUST_CHANGED_MS)
    stow_it.click()
    until(lambda: stowed(storm) == ["T31"], "the order arrives")


def test_what_is_told_above_all_passes_to_the_next_and_stows_that_one(storm: Plant, opened: Opened) -> None:
    page = opened("/", "tablet", still=True)
    urgent = page.locator("#site-urgent")
    expect(page.locator("#urgent-more")).to_have_text("2 more")
    storm.do(lambda: stow(storm.machine, "T31"))
    expect(urgent.locator("h2")).to_have_text("T47 Row 47: Not stowed")
    expect(page.locator("#urgent-more")).to_have_text("1 more")
    page.get_by_role("button", name="Stow T47").click()
    expect(urgent.locator(".outcome")).to_contain_text("has just changed")
    assert stowed(storm) == [], "whoever pressed it may have meant the tracker before"
    page.clock.run_for(JUST_CHANGED_MS)
    page.get_by_role("button", name="Stow T47").click()
    until(lambda: stowed(storm) == ["T47"], "the order arrives")
    page.clock.run_for(CLICKS_WITHIN_MS)
    storm.do(lambda: (stow(storm.machine, "T47"), stow(storm.machine, "T52")))
    expect(urgent).to_be_hidden()
    storm.do(lambda: endanger(storm.machine, "T9"))
    expect(urgent.locator("h2")).to_have_text("T9 Row 9: Not stowed")
    page.clock.run_for(JUST_CHANGED_MS)
    page.locator("#urgent-open").click()
    expect(page).to_have_url(f"{storm.url}/trackers/T9")


def test_a_press_is_for_the_tracker_that_was_under_the_finger(storm: Plant, opened: Opened) -> None:
    page = opened("/", "tablet", still=True)
    page.get_by_role("button", name="Stow T31").hover()
    page.mouse.down()
    storm.do(lambda: endanger(storm.machine, "T5"))
    expect(count(page, "not_stowed").locator("b")).to_have_text("4")
    page.mouse.up()
    until(lambda: stowed(storm) == ["T31"], "the order arrives")
    expect(page.locator("#site-urgent h2")).to_contain_text("T31")
    page.clock.run_for(CLICKS_WITHIN_MS + 1)
    expect(page.locator("#site-urgent h2")).to_contain_text("T5")


def test_from_the_alarms_it_is_one_tap_to_the_tracker(storm: Plant, opened: Opened) -> None:
    page = opened("/alarms", "tablet")
    link = page.locator("#alarm-list .alarm-open").nth(1)
    box = link.bounding_box()
    assert box is not None
    assert box["height"] >= 64
    assert box["width"] >= 64
    link.click()
    expect(page).to_have_url(f"{storm.url}/trackers/T47")
