"""A technician walks the five steps with a finger alone, and with a keyboard alone; e2e walks by mouse."""

import re

import pytest
from playwright.sync_api import Browser, Page

from app.tracker.state.snapshot import ActivityName
from tests.browser.hands import CONFIRM_MS, LINK_MEASURED, Finger, Hands, Keyboard
from tests.browser.page_clock import BEAT_MS
from tests.browser.site_stage import SiteStage, staged_site

STEPS = "/trackers/T1/commissioning"
HANDS: dict[str, type[Hands]] = {"finger": Finger, "keyboard": Keyboard}
COARSE_MS = 20 * BEAT_MS
"""A beat while an axis turns far and nothing is held: short enough for a page to see that its link is up."""


def shows(stage: SiteStage, page: Page, selector: str, words: str = "") -> None:
    stage.until(lambda: page.locator(selector, has_text=words).count())


def onwards(stage: SiteStage, page: Page, hands: Hands, to: str) -> None:
    shows(stage, page, "#forward .key")
    hands.press(page.locator("#forward .key"))
    page.wait_for_url(re.compile(f"{to}$"))
    stage.live(page)


@pytest.mark.parametrize(("hand", "size"), [("finger", "phone"), ("keyboard", "desk")])
def test_five_steps(hand: str, size: str, browser: Browser) -> None:
    with staged_site(browser) as stage:
        page = stage.open(f"{STEPS}/location", size, touch=hand == "finger", allow=("422",))
        hands = HANDS[hand](page, stage.advance)  # type: ignore[call-arg]
        hands.write(page.locator("#f-latitude"), "41° 17' 12,1\"")
        hands.write(page.locator("#f-longitude"), "36,33")
        shows(stage, page, "#preview", "Europe/Istanbul")
        onwards(stage, page, hands, "/clock")
        hands.press(page.locator('form[action$="/clock/system"] button'))
        shows(stage, page, "#forward a.key")
        onwards(stage, page, hands, "/homing")
        home(stage, page, hands)
        onwards(stage, page, hands, "/mode")
        hands.choose(page.locator('input[value="dual"]'))
        onwards(stage, page, hands, "/run")
        hands.press(page.locator('[data-action="track"]'))
        stage.beat_ms = COARSE_MS
        shows(stage, page, ".strip-activity", "Tracking")
        shows(stage, page, '.step[data-current][data-status="done"]')
        hands.press(page.locator("#stop-key"))
        shows(stage, page, ".strip-activity", "Holding")
        assert stage.tracker.activity is ActivityName.HOLDING


def home(stage: SiteStage, page: Page, hands: Hands) -> None:
    """Turn an axis by hand, set the home position there, and say that it is right."""
    key = page.locator('[data-jog="azimuth"][data-direction="1"]')
    stage.until(lambda: page.locator(LINK_MEASURED).count() and key.is_enabled())
    reading = page.locator('[data-live="measured.azimuth_deg"]').first
    before = reading.inner_text()
    hands.hold(key)
    stage.until(lambda: reading.inner_text() != before)
    stage.until(page.locator('[data-action="set_home"]').first.is_enabled)
    hands.hold(page.locator('[data-action="set_home"]').first, CONFIRM_MS)
    shows(stage, page, '[name="confirmed"]')
    hands.hold(page.locator('[name="confirmed"]'), CONFIRM_MS)
    stage.until(lambda: reading.inner_text() == "0.00°")
