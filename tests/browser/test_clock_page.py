"""Step 2 in one view: two clocks with the sky that each means, one choice, and one tap to go on."""

import re
from dataclasses import replace
from datetime import timedelta

import pytest
from playwright.sync_api import Page, expect

from app.link.messages import ConfirmStep, SetClock
from app.sun.position import Algorithm, sun_position
from app.tracker.memory.memory import ClockSetting
from tests.browser.conftest import Opened, Plant, now
from tests.browser.hands import arrive
from tests.browser.page_clock import Stage
from tests.browser.test_asked import LATE
from tests.browser.test_clock_held import set_ahead

CLOCK = "/trackers/T1/commissioning/clock"
SURE = '.question [name="confirmed"]'
NUMBER = re.compile(r"[−-]?\d+[.,]\d")
SCROLLED = "document.documentElement.scrollHeight - innerHeight"
HIDDEN = """() => [...document.querySelectorAll(
  '#clock-apart, .clock-choices .key, .slots .key, .question .key, #stop-key')].filter((key) => {
  if (!key.checkVisibility()) return false;
  const { x, y, width, height, bottom } = key.getBoundingClientRect();
  const top = document.elementFromPoint(x + width / 2, y + height / 2);
  return bottom > innerHeight || !(key.contains(top) || top?.contains(key));
}).map((key) => key.textContent)"""
WORDS = """() => {
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  const aside = '.header, .rail, .steps, .footer-note, .visually-hidden, .skip, .stop-not-possible, .help';
  const found = [];
  for (let text; (text = texts.nextNode());) {
    const { parentElement: holder } = text;
    if (!holder.checkVisibility() || holder.closest(aside)) continue;
    found.push(...text.data.match(/[\\p{L}']{2,}/gu) ?? []);
  }
  return found.length;
}"""
MOST_WORDS = 60


def forward(page: Page) -> None:
    page.locator("#forward .key").click()


def choose(page: Page, source: str) -> None:
    page.locator(f'input[name="source"][value="{source}"]').check()


def test_one_tap_keeps_the_clock_and_goes_on(opened: Opened, plant: Plant) -> None:
    page = opened(CLOCK, "tablet")
    expect(page.locator('input[name="source"][value="keep"]')).to_be_checked()
    expect(page.locator("#clock-apart")).to_contain_text("the clocks agree")
    forward(page)
    arrive(page, "/commissioning/homing")
    assert [order.command for order in plant.machine.orders] == [SetClock("system")]


def test_a_question_goes_away_with_another_choice_and_with_no(opened: Opened, plant: Plant) -> None:
    now(plant, plant.machine.rest)
    page = opened(CLOCK, "tablet", allow=("422",))
    page.evaluate(LATE)
    for leave in (lambda: choose(page, "keep"), lambda: page.locator("[data-cancel]").click()):
        choose(page, "device")
        forward(page)
        expect(page.locator(SURE)).to_be_visible()
        leave()
        expect(page.locator(".question")).to_have_count(0)
    assert not plant.machine.orders


def manual(plant: Plant) -> None:
    """Have a clock in use that somebody set, and that shows the same."""
    machine = plant.machine
    machine.site = replace(machine.site, clock=ClockSetting("manual", 0.0, machine.clock.now()))
    machine.emit()


def test_a_clock_that_was_set_manually_is_kept_by_keep(opened: Opened, plant: Plant) -> None:
    now(plant, lambda: manual(plant))
    page = opened(CLOCK, "phone")
    expect(page.locator(".clock-source").first).to_contain_text("set manually since")
    forward(page)
    arrive(page, "/commissioning/homing")
    assert [type(order.command) for order in plant.machine.orders] == [ConfirmStep]


def test_the_clock_of_the_system_is_used_again_by_its_own_choice(opened: Opened, plant: Plant) -> None:
    now(plant, lambda: manual(plant))
    page = opened(CLOCK, "phone")
    choose(page, "system")
    forward(page)
    arrive(page, "/commissioning/homing")
    assert [order.command for order in plant.machine.orders] == [SetClock("system")]


def test_each_card_has_the_sun_of_its_own_clock(stage: Stage) -> None:
    stage.do(stage.plant.machine.rest)
    stage.do(lambda: set_ahead(stage.plant.machine))
    page = stage.open(CLOCK, "tablet")
    shown = page.locator("#device-sun")
    stage.until(lambda: NUMBER.search(shown.inner_text()))
    place = stage.plant.machine.site.location
    assert place is not None
    for by in (timedelta(0), timedelta(minutes=2)):
        stage.beat_ms = 500
        stage.advance(round(by.total_seconds() * 1000))
        sun = sun_position(Algorithm.PSA, place, stage.clock.now())
        azimuth_deg, elevation_deg = (
            float(one.replace("−", "-")) for one in NUMBER.findall(shown.inner_text())
        )
        assert azimuth_deg == pytest.approx(sun.azimuth_deg, abs=0.4)
        assert elevation_deg == pytest.approx(sun.apparent_elevation_deg, abs=0.4)
    site = stage.plant.machine.latest()
    assert site is not None
    assert site.sun is not None
    assert (
        f"{site.sun.apparent_elevation_deg:.1f}°".replace("-", "−")
        in page.locator("#controller-sun").inner_text()
    )
    assert page.locator("#device-sky:not([data-down])").count() == 1


def test_without_a_location_there_is_no_sky(opened: Opened, plant: Plant) -> None:
    def nowhere() -> None:
        plant.machine.site = replace(plant.machine.site, location=None)
        plant.machine.emit()

    now(plant, nowhere)
    page = opened(CLOCK, "tablet")
    expect(page.locator("#step-form")).to_contain_text("Save the location first.")
    expect(page.locator(".sky")).to_have_count(0)


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_all_is_in_one_view_with_and_without_a_question(
    size: str, language: str, opened: Opened, plant: Plant
) -> None:
    now(plant, plant.machine.rest)
    page = opened(CLOCK, size, language=language, allow=("422",))

    def fits() -> None:
        assert page.evaluate(SCROLLED) <= 0
        assert page.evaluate(HIDDEN) == []
        assert language != "en" or page.evaluate(WORDS) <= MOST_WORDS

    fits()
    page.evaluate(LATE)
    expect(page.locator("#clock-apart[data-off]")).to_have_count(1)
    expect(page.locator("#device-sun")).to_contain_text(NUMBER)
    fits()
    for source in ("device", "keep"):
        choose(page, source)
        forward(page)
        expect(page.locator(SURE)).to_be_visible()
        fits()


@pytest.mark.parametrize("language", ["en", "de"])
def test_the_shadow_test_is_in_one_view_and_leads_back(language: str, opened: Opened, plant: Plant) -> None:
    now(plant, plant.machine.rest)
    page = opened(CLOCK, "tablet", language=language, allow=("422",))
    page.locator(".slot-1 .key").click()
    arrive(page, "/clock/shadow")
    expect(page.locator("#shadow-arrow")).to_be_attached()
    expect(page.locator("#forward .key")).to_have_count(0)
    page.locator("#f-time").fill("03:00")
    page.locator("#manual-form .key-main").click()
    expect(page.locator(SURE)).to_be_visible()
    assert page.evaluate(SCROLLED) <= 0
    page.locator("#f-time").fill("04:00")
    expect(page.locator(".question")).to_have_count(0)
    page.locator(".slot-back").click()
    arrive(page, "/commissioning/clock")
    assert not plant.machine.orders
