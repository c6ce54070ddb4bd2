"""A show on the machine is seen whole while it runs, and ends where it ended."""

from datetime import UTC, datetime, timedelta
from functools import partial

import pytest
from playwright.sync_api import expect

from app.store.store import PlannedShow
from app.tracker.programs.show import ShowPlan
from app.tracker.state.snapshot import ActivityName, Event, EventKind, ShowPhase
from tests.browser.conftest import Opened, Plant, go
from tests.fake_data import SAMSUN

SHOW = "/trackers/T1/shows/s1"
PLAN = ShowPlan(
    "s1",
    datetime(2026, 6, 21, 5, tzinfo=UTC),
    datetime(2026, 6, 21, 14, tzinfo=UTC),
    timedelta(minutes=3),
    SAMSUN,
)

PRINTING = """() => {
  window.printing = new Promise((done) => {
    window.print = () => done(document.querySelectorAll(".chart canvas").length);
  });
}"""


def at(plant: Plant, part: float, phase: ShowPhase = ShowPhase.RUNNING) -> None:
    """Bring the show of the fake machine to a part of its length."""
    plant.machine.store.shows["s1"] = PlannedShow("T1", PLAN)
    tracker = plant.machine.trackers["T1"]
    tracker.show, tracker.shown, tracker.activity = (PLAN, phase), part, ActivityName.SHOWING


def over(plant: Plant) -> None:
    tracker = plant.machine.trackers["T1"]
    tracker.show, tracker.activity = None, ActivityName.HOLDING


@pytest.fixture
def under_way(plant: Plant) -> Plant:
    at(plant, 0.4)
    return plant


def test_a_show_that_has_run_to_its_end_says_so_to_the_last_second(under_way: Plant, opened: Opened) -> None:
    page = opened(SHOW, "desk")
    under_way.do(partial(at, under_way, 0.996))
    expect(page.locator("#show-elapsed")).to_contain_text("2 min 59 s")
    under_way.do(partial(over, under_way))
    expect(page.locator("#show-phase")).to_have_text("Ended")
    expect(page.locator("#show-clock")).to_have_text("17:00:00")
    assert page.locator("#show-progress").evaluate("bar => bar.value") == 1
    expect(page.locator("#show-elapsed")).to_contain_text("3 min of 3 min")


def test_a_show_that_was_stopped_stays_where_it_was_and_says_why_and_by_whom(
    under_way: Plant, opened: Opened
) -> None:
    page = opened(SHOW, "desk")
    why, noon = "The show was stopped by the operator.", datetime(2026, 6, 21, 9, 36, 5, tzinfo=UTC)
    line = Event(noon, EventKind.SHOW_ENDED, "T1", why, "anna", {"show_id": "s1", "outcome": "stopped"})
    happens = [lambda: under_way.machine.emit(line), partial(over, under_way)]
    for order in (happens, happens[::-1]):
        expect(page.locator("#show-phase")).to_have_text("Running")
        expect(page.locator("#show-clock")).to_have_text("11:36:00")
        for one in order:
            under_way.do(one)
            expect(page.locator("#show-clock")).to_have_text("11:36:00")
        expect(page.locator("#show-phase")).to_have_text("Ended")
        expect(page.locator("#show-elapsed")).to_have_text(f"12:36:05 · anna · {why}")
        under_way.do(partial(at, under_way, 0.4))
        go(page, page.url)


def test_the_sun_outside_is_not_drawn_into_a_show_that_is_over(under_way: Plant, opened: Opened) -> None:
    page = opened(SHOW, "desk")
    sun = page.locator('.show-grid .sunpath [data-mark="sun"]')
    expect(sun).to_have_attribute("visibility", "visible")
    under_way.do(partial(over, under_way))
    expect(page.get_by_text("Pointing error", exact=True).first).to_be_hidden()
    page.reload()
    expect(page.locator("#show-phase")).to_have_text("Not on the controller")
    expect(sun).to_have_attribute("visibility", "hidden")


def test_the_replay_key_plays_what_was_recorded_of_this_show(under_way: Plant, opened: Opened) -> None:
    over(under_way)
    shown = under_way.machine.store.heads["show-1"]
    under_way.machine.store.shows["s1"] = PlannedShow(
        "T1",
        ShowPlan("s1", shown.sun_start, shown.sun_end, timedelta(seconds=shown.duration_s), SAMSUN),
    )
    page = opened(SHOW, "tablet", touch=True)
    page.get_by_role("link", name="Replay").tap()
    page.wait_for_url("**/recordings/show-1")


def test_a_replay_is_printed_with_both_curves_though_nobody_has_looked_at_them(
    plant: Plant, opened: Opened
) -> None:
    page = opened("/recordings/show-1", "tablet")
    page.evaluate(PRINTING)
    expect(page.locator("#errors canvas")).to_have_count(0)
    page.locator("#player-print").click()
    assert page.evaluate("printing") == 2
