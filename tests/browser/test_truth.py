"""The bar and the page follow a tracker through its states, and tell at once what is most urgent."""

from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from app.base.message import N_
from app.tracker.state.snapshot import Event, EventKind, Pair
from app.web.languages.known import in_words
from app.web.shell.page_facts import told_in_page
from tests.browser.conftest import Opened, Plant, now
from tests.every_state import AT, CASES, FAULT, StagedTracker, short_walk
from tests.fake_alarms import alarm
from tests.fake_data import commissioned
from tests.patience import until

T1 = "/trackers/T1"
JUST_CHANGED_MS = 700
PING_MS = 1000
MOST_APART_S = 60.0
TOLD = """() => {
  const seen = (one) => one.checkVisibility() && one.getBoundingClientRect().top < innerHeight;
  const [says, card] = [document.getElementById("says"), document.getElementById("urgent")];
  return {
    states: [...new Set([...document.querySelectorAll("[data-live=state]")].map((one) => one.textContent))],
    bar: [says.dataset.code, says.dataset.priority, seen(says.querySelector(".says-words"))],
    message: says.querySelector(".says-first").textContent,
    page: card && !card.hidden && seen(card) ? card.dataset.code : "",
    listed: [...says.querySelectorAll(".message")].map((one) => one.dataset.code),
  };
}"""
"""What a page tells of the state and of what is most urgent, where it is in sight without a tap."""
JOG_KEYS = "() => [...document.querySelectorAll('[data-jog]')].map((one) => one.getBoundingClientRect().top)"


def stage(plant: Plant) -> StagedTracker:
    tracker = StagedTracker(commissioned("T1", "North field", tracking=False), Pair(180.0, 45.0))
    plant.machine.trackers["T1"] = tracker
    return tracker


def bring(plant: Plant, tracker: StagedTracker, name: str) -> None:
    """Have a tracker in a state, and told to the page."""
    tracker.case = CASES[name]
    now(plant, plant.machine.emit)


def told(page: Page, word: str) -> dict[str, Any]:
    expect(page.locator(".says-state")).to_have_text(word)
    found: dict[str, Any] = page.evaluate(TOLD)
    return found


@pytest.mark.parametrize("size", ["tablet", "phone"])
def test_a_page_follows_a_tracker_through_its_states(size: str, plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    page = opened(T1, size, allow=("WebGL",))
    for name in short_walk():
        bring(plant, tracker, name)
        case = CASES[name]
        expect(page.locator("#says")).to_have_attribute("data-code", case.first)
        found = told(page, in_words(case.word))
        assert found["states"] == [in_words(case.word)], name
        assert found["bar"][0::2] == [case.first, True], name
        urgent = told_in_page(plant.machine.latest().trackers[0])  # type: ignore[union-attr]
        assert found["page"] == (urgent.code if urgent else ""), name
        assert found["listed"][:1] == [case.first][: len(found["listed"])], name
        assert bool(found["message"]) is bool(case.first), name


def test_a_stop_by_somebody_is_told_and_ends_what_was_told_before(plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    page = opened(f"{T1}/settings", "tablet")
    for kind, text, actor in (
        (EventKind.TRACKING_STARTED, "Tracking started, mode dual.", "zoe"),
        (EventKind.STOPPED, "North field was stopped.", "ada"),
    ):
        event = Event(AT, kind, "T1", N_(text), actor)
        now(plant, lambda event=event: plant.machine.emit(event))  # type: ignore[misc]
    expect(page.locator(".says-first")).to_have_text(f"Stopped by ada · {page_time(page)}")
    assert "Tracking started" not in (page.locator("#says").text_content() or "")
    bring(plant, tracker, "not stowed")
    expect(page.locator("#says")).to_have_attribute("data-code", "not_stowed")
    expect(page.locator(".says-first")).to_have_text(f"Stopped by ada · {page_time(page)}")
    expect(page.locator(".message-title").first).to_have_text("Not stowed")


def page_time(page: Page) -> str:
    return str(
        page.evaluate(
            """at => new Intl.DateTimeFormat("sv-SE", {
      timeZone: document.documentElement.dataset.zone, hour: "2-digit", minute: "2-digit", second: "2-digit",
    }).format(new Date(at))""",
            AT.isoformat(),
        )
    )


def test_an_action_that_is_off_says_why_when_it_is_pressed(plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    tracker.refused = (FAULT,)
    page = opened(T1, "tablet", allow=("WebGL",))
    form = page.locator('.slots form[action="/trackers/T1/park"]')
    why = form.locator(".reasons")
    expect(form.locator("button")).to_be_disabled()
    expect(form).not_to_have_attribute("data-told", "")
    box = form.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + 20, box["y"] + 20)
    expect(form).to_have_attribute("data-told", "")
    assert why.bounding_box()["width"] > 200  # type: ignore[index]
    expect(why).to_contain_text("The elevation axis does not follow.")
    page.mouse.click(300, 700)
    expect(form).not_to_have_attribute("data-told", "")
    assert why.bounding_box()["width"] <= 1  # type: ignore[index]
    form.focus()
    expect(form).to_have_attribute("data-told", "")


def test_on_a_phone_keys_to_hold_that_are_off_say_why_in_sight(plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    tracker.refused = (FAULT,)
    page = opened(f"{T1}/commissioning/homing", "phone")
    key, why = page.locator('[data-jog="azimuth"]').first, page.locator(".jog-says > .reasons")
    expect(key).to_be_disabled()
    places = page.evaluate(JOG_KEYS)
    box = key.bounding_box()
    assert box is not None
    page.mouse.click(box["x"] + 20, box["y"] + 20)
    expect(page.locator(".jog")).to_have_attribute("data-told", "")
    expect(why).to_contain_text("The elevation axis does not follow.")
    told = why.bounding_box()
    assert told is not None
    footer = page.locator(".footer").bounding_box()
    assert footer is not None
    assert 0 <= told["y"] < told["y"] + told["height"] <= footer["y"]
    assert page.evaluate(JOG_KEYS) == places
    page.locator(".jog-safety").click()
    expect(page.locator(".jog")).not_to_have_attribute("data-told", "")


def test_a_second_tap_does_not_start_what_the_first_one_ended(plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    bring(plant, tracker, "tracking")
    page = opened(T1, "tablet", still=True, allow=("WebGL",))
    slot = page.locator(".slots .slot").first
    slot.locator("button:visible").click()
    until(lambda: given(plant) == ["Stop"], "tracking is ended")
    bring(plant, tracker, "at standstill")
    start = slot.get_by_role("button", name="Start tracking")
    start.click()
    expect(slot.locator('form[action$="/track"] .outcome')).to_contain_text("has just changed")
    assert given(plant) == ["Stop"]
    page.clock.run_for(JUST_CHANGED_MS)
    start.click()
    until(lambda: given(plant) == ["Stop", "Track"], "tracking is started")
    bring(plant, tracker, "tracking")
    expect(start).to_be_hidden()
    bring(plant, tracker, "interrupted")
    expect(start).to_be_visible()
    expect(slot.get_by_role("button", name="End tracking")).to_be_hidden()


def test_no_alarm_is_acknowledged_that_came_under_a_finger_or_the_focus(plant: Plant, opened: Opened) -> None:
    tracker = stage(plant)
    plant.machine.alarms = (alarm("drive_lost", AT),)
    bring(plant, tracker, "silent drive while it holds")
    page = opened(T1, "tablet", still=True, allow=("WebGL",))
    card = page.locator("#urgent")
    acknowledge = card.get_by_role("button", name="Acknowledge")
    acknowledge.focus()
    plant.machine.alarms += (alarm("not_stowed", AT),)
    bring(plant, tracker, "not stowed")
    expect(card).to_have_attribute("data-code", "not_stowed")
    expect(acknowledge).not_to_be_focused()
    acknowledge.click()
    expect(card.locator(".outcome")).to_contain_text("has just changed")
    assert given(plant) == []
    page.clock.run_for(JUST_CHANGED_MS)
    acknowledge.click()
    until(lambda: given(plant) == ["AcknowledgeAlarm"], "the alarm is acknowledged")


def given(plant: Plant) -> list[str]:
    return [type(order.command).__name__ for order in plant.machine.orders]


def test_a_page_tells_what_the_clock_of_its_device_shows(plant: Plant, opened: Opened) -> None:
    page, by = opened(T1, still=True), timedelta(hours=1)
    page.clock.set_system_time(datetime.now(UTC) + by)

    def told() -> bool:
        page.clock.run_for(PING_MS)
        return any(
            abs(one + by.total_seconds()) < MOST_APART_S for one in plant.machine.device_clocks.values()
        )

    until(told, "the page tells that its device's clock is an hour off")
