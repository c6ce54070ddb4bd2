"""A clock that differs from this device's, and a longitude on the wrong side, are asked about on the page."""

import re

from playwright.sync_api import expect

from app.link.messages import SetClock, SetLocation
from tests.browser.conftest import Opened, Plant
from tests.browser.hands import CONFIRM_MS, Mouse, confirm
from tests.browser.page_clock import BEAT_MS, Stage

CLOCK = "/trackers/T1/commissioning/clock"
HOMING = "/trackers/T1/commissioning/homing"
PLACE = "/trackers/T1/commissioning/location"
LATE = """() => {
  const [now, Real] = [Date.now, Date];
  const late = 41_940_000;
  window.Date = class extends Real {
    constructor(...given) { given.length ? super(...given) : super(now() - late); }
  };
  window.Date.now = () => now() - late;
}"""


COVERED = """(key) => {
  const box = key.getBoundingClientRect();
  const top = (x, y) => document.elementFromPoint(x, y);
  const points = [box.left + 8, box.x + box.width / 2, box.right - 8]
    .flatMap((x) => [box.top + 8, box.y + box.height / 2, box.bottom - 8].map((y) => [x, y]));
  return points.filter(([x, y]) => top(x, y)?.closest("button, label") !== key);
}"""


def asked(plant: Plant, kind: type) -> int:
    return len([order for order in plant.machine.orders if isinstance(order.command, kind)])


def test_a_clock_11_hours_off_is_amber_and_asked_about(opened: Opened, plant: Plant) -> None:
    page = opened(CLOCK, "phone", allow=("422",))
    expect(page.locator("#clock-apart[data-off]")).to_have_count(0)
    page.evaluate(LATE)
    apart = page.locator("#clock-apart[data-off]")
    expect(apart).to_contain_text("11 h 39 min")
    assert apart.evaluate("e => getComputedStyle(e).borderTopColor") == "rgb(255, 176, 0)"
    page.locator("#forward .key").click()
    expect(page.locator(".question")).to_contain_text("11 h 39 min ahead of this device's clock")
    assert page.locator('.question [name="confirmed"]').evaluate(COVERED) == []
    assert asked(plant, SetClock) == 0
    page.locator('.question [name="confirmed"]').click()
    expect(page).to_have_url(re.compile("/homing$"))
    assert asked(plant, SetClock) == 1


def test_a_clock_that_cannot_be_copied_says_so_where_it_is_seen(opened: Opened) -> None:
    page = opened(CLOCK, "tablet", allow=("409",))
    page.set_viewport_size({"width": 1024, "height": 700})  # its button is in view, what stands below is not
    page.evaluate(LATE)
    expect(page.locator("#clock-apart[data-off]")).to_have_count(1)
    page.locator('input[value="device"]').check()
    page.locator("#forward .key").click()
    refused = page.locator(".outcome-refused")
    expect(refused).to_contain_text("T2 is tracking the sun by the present clock.")
    expect(refused).to_be_in_viewport(ratio=1)


def test_a_longitude_on_the_wrong_side_is_asked_about(opened: Opened, plant: Plant) -> None:
    plant.machine.rest()
    page = opened(PLACE, "tablet", still=True, allow=("422",))
    page.locator('input[name="longitude_side"][value="W"]').check()
    page.locator("#forward .key").click()
    doubts = page.locator("#place-doubts")
    expect(doubts).to_contain_text("with east and west swapped")
    assert asked(plant, SetLocation) == 0
    page.locator("#forward .key").click()
    expect(doubts).to_contain_text("with east and west swapped")
    assert asked(plant, SetLocation) == 0, "it is asked again, not answered"
    confirm(page, page.locator('[name="sun_there"]'), page.clock.run_for)
    expect(page).to_have_url(re.compile("/clock$"))
    assert asked(plant, SetLocation) == 1


def test_the_key_of_the_question_of_the_home_position_is_not_covered(stage: Stage) -> None:
    page = stage.open(HOMING, "phone", language="de", allow=("422", "409"))
    Mouse(page, stage.advance).hold(page.locator('[data-action="set_home"][data-after-jog]'), CONFIRM_MS)
    sure = page.locator('#zero-outcome [name="confirmed"]')
    sure.wait_for()
    stage.advance(BEAT_MS)
    assert sure.evaluate(COVERED) == []
