"""A technician connects a drive over Modbus TCP and measures it on the real service: its own times."""

import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright

from tests.browser.conftest import CHROMIUM, FLAGS
from tests.browser.hands import Finger, Hands
from tests.browser.walking import Walker, add_tracker, rooms, service, walker
from tests.e2e.chromium import PAGE_READY
from tests.e2e.letters import environment
from tests.e2e.product import DriveSim
from tests.patience import PATIENCE_MS

__all__ = ["rooms", "service", "walker"]


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """Run a browser for this file: Playwright's loop must have ended before the next file runs its own."""
    expect.set_options(timeout=PATIENCE_MS)
    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS, env=environment())
        yield started
        started.close()


@pytest.fixture
def sim_port() -> Iterator[int]:
    """Run a simulated drive of its own and give its port."""
    sim = DriveSim.start()
    yield sim.port
    sim.stop()


def test_a_drive_is_connected_and_its_watchdog_tested_with_a_finger(
    walker: Walker, service: str, sim_port: int
) -> None:
    page = walker("phone", "finger")
    hands = Finger(page, page.wait_for_timeout)
    add_tracker(page, hands, service, "drive")
    fast = {"azimuth": {"jog_fast_dps": 6.0}, "elevation": {"jog_fast_dps": 4.0}}
    assert httpx.patch(f"{service}/api/v1/trackers/drive", json=fast).status_code == 200
    connect(page, hands, f"{service}/trackers/drive/drive", sim_port)
    opened(page, f"{service}/trackers/drive/drive-tests")
    check_direction(page, hands)
    measure(page, hands)


def opened(page: Page, url: str) -> None:
    page.goto(url)
    page.wait_for_selector(PAGE_READY)


def connect(page: Page, hands: Hands, url: str, port: int) -> None:
    opened(page, url)
    page.locator("#f-kind").select_option("modbus-tcp")
    hands.write(page.locator("#f-host"), "127.0.0.1")
    hands.write(page.locator("#f-port"), str(port))
    hands.press(page.get_by_role("button", name="Test the connection"))
    found = page.locator("#drive-check")
    expect(found).to_contain_text("The device answers")
    expect(found).to_contain_text("0.5 s, read back from the drive")
    hands.press(page.get_by_role("button", name="Save the drive settings"))
    page.wait_for_url(re.compile("done=saved"))
    expect(page.locator("#f-port")).to_have_value(str(port))


def state(page: Page, proof: str, row: int = 0) -> Locator:
    return page.locator(f"#proof-{proof} .proof-states > li").nth(row)


def check_direction(page: Page, hands: Hands) -> None:
    hands.press(page.get_by_role("button", name="Turn elevation by 3°"))
    expect(page.locator(".ask")).to_contain_text("tilt up, toward the sky?")
    hands.press(page.get_by_role("button", name="Yes"))
    expect(state(page, "direction", 1)).to_have_attribute("data-status", "done")


def measure(page: Page, hands: Hands) -> None:
    hands.press(page.get_by_role("button", name="Elevation, jog speed"))
    expect(state(page, "stop", 2)).to_contain_text(re.compile(r"was at standstill 0\.\d\d s"))
    hands.press(page.get_by_role("button", name="Test with elevation"))
    expect(page.locator(".says-text")).to_contain_text("Communication-loss test")
    expect(state(page, "link-loss")).to_contain_text(re.compile(r"slowed down after 0\.[4-7]\d s"))
    expect(state(page, "link-loss")).to_have_attribute("data-status", "done")
