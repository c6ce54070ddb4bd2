"""*Set as zero* is held for 2 s, asks where the drive reads another angle, and is undone."""

from dataclasses import replace

import pytest
from playwright.sync_api import Page

from app.tracker.commands.commands import UndoHome
from tests.browser.hands import Finger, Hands, Keyboard, Mouse
from tests.browser.page_clock import BEAT_MS, Stage

HOMING = "/trackers/T1/commissioning/homing"
SET = '[data-action="set_home"][data-after-jog]'
SURE = '[name="confirmed"]'
UNDO = 'form[action$="/zero/undo"] button'
HOMED = ".homed-note:visible"
HANDS: dict[str, type[Hands]] = {"finger": Finger, "keyboard": Keyboard}
COUNTS_MS = 2000
COARSE_MS = 250
"""A beat of those to whom the very instant does not matter: a page's pings are a multiple of it."""


def shows(stage: Stage, page: Page, selector: str) -> None:
    """Return once an answer has put something on the page."""
    stage.until(page.locator(selector).count)


def zeros(stage: Stage) -> int:
    return len(stage.plant.orders("set_home"))


def set_home(stage: Stage, page: Page, hands: Hands) -> None:
    hands.hold(page.locator(SET), COUNTS_MS + COARSE_MS)
    shows(stage, page, SURE)
    hands.hold(page.locator(SURE), COUNTS_MS + COARSE_MS)
    stage.until(lambda: page.locator(SURE).count() == 0)


@pytest.mark.parametrize("hand", list(HANDS))
def test_it_is_held_asked_about_and_undone(hand: str, stage: Stage) -> None:
    is_finger = hand == "finger"
    stage.beat_ms = COARSE_MS
    too_short_ms, long_enough_ms = COUNTS_MS - stage.beat_ms, COUNTS_MS + stage.beat_ms
    page = stage.open(HOMING, "phone" if is_finger else "tablet", touch=is_finger, allow=("422",))
    hands = HANDS[hand](page, stage.advance)
    hands.hold(page.locator(SET), too_short_ms)
    stage.advance(500)
    assert page.locator(SURE).count() == 0
    hands.hold(page.locator(SET), long_enough_ms)
    shows(stage, page, "#zero-outcome .question")
    assert "The measured azimuth is 180.0°" in page.locator("#zero-outcome .question").inner_text()
    hands.hold(page.locator(SURE), too_short_ms)
    stage.advance(500)
    assert zeros(stage) == 0
    hands.hold(page.locator(SURE), long_enough_ms)
    stage.until(lambda: page.locator(SURE).count() == 0)
    assert zeros(stage) == 1
    stage.until(page.locator(UNDO).is_visible)
    stage.advance(500)
    assert stage.plant.orders("undo_home") == [], "letting go pressed the key that came under the finger"
    Keyboard(page, stage.advance).press(page.locator(UNDO))
    reading = page.locator('[data-live="measured.azimuth_deg"]').first
    stage.until(lambda: reading.inner_text() == "180.00°")


def test_message_and_lamps_follow_when_it_is_undone(stage: Stage) -> None:
    tracker = stage.plant.machine.trackers["T1"]
    stage.do(lambda: setattr(tracker, "memory", replace(tracker.memory, home=None)))
    stage.beat_ms = COARSE_MS
    page = stage.open(HOMING, "tablet", allow=("422",))
    hands, outcome = Mouse(page, stage.advance), page.locator("#zero-outcome")
    stage.until(lambda: page.locator(HOMED).count() == 0)
    stage.beat_ms = BEAT_MS
    hands.hold(page.locator('[data-jog="azimuth"][data-direction="1"]'), 3 * COARSE_MS)
    assert is_blue(page), "without home switches, setting it is what this page is for"
    stage.beat_ms = COARSE_MS
    for undone in (
        lambda: stage.do(lambda: tracker.handle(UndoHome(), stage.clock.now(), "somebody else")),
        lambda: page.locator(UNDO).click(),
    ):
        set_home(stage, page, hands)
        stage.until(lambda: page.locator(HOMED).count() == 1)
        assert outcome.inner_text() == ""
        undone()
        stage.until(page.locator(UNDO).is_hidden)
        assert outcome.inner_text() == ""
        assert page.locator(HOMED).count() == 0


def is_blue(page: Page) -> bool:
    return bool(page.locator(SET).evaluate("e => e.classList.contains('key-primary')"))


def test_a_question_about_other_readings_is_not_answered(stage: Stage) -> None:
    stage.beat_ms = COARSE_MS
    page = stage.open(HOMING, "tablet", allow=("422",))
    hands = Mouse(page, stage.advance)
    hands.hold(page.locator(SET), COUNTS_MS + COARSE_MS)
    shows(stage, page, SURE)
    stage.beat_ms = BEAT_MS
    hands.hold(page.locator('[data-jog="azimuth"][data-direction="1"]'), 3 * COARSE_MS)
    assert page.locator(SURE).count() == 0, "it named where the axes were"
    assert zeros(stage) == 0
