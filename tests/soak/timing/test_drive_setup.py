"""A technician connects a drive over Modbus TCP and proves it on the real service, by mouse and by finger."""

import re
from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.conftest import browser, picture
from tests.browser.hands import Finger, Hands, Mouse
from tests.browser.walking import Picture, Walker, add_tracker, move_by_hand, rooms, service, walker
from tests.e2e.chromium import PAGE_READY
from tests.e2e.product import DriveSim

__all__ = ["browser", "picture", "rooms", "service", "walker"]


@pytest.fixture
def sim_port() -> Iterator[int]:
    """Run a simulated drive of its own and give its port."""
    sim = DriveSim.start()
    yield sim.port
    sim.stop()


def opened(page: Page, url: str) -> None:
    page.goto(url)
    page.wait_for_selector(PAGE_READY)


def connect(page: Page, hands: Hands, url: str, port: int, picture: Picture, name: str) -> None:
    opened(page, f"{url}/drive")
    page.locator("#f-kind").select_option("modbus-tcp")
    hands.write(page.locator("#f-host"), "127.0.0.1")
    hands.write(page.locator("#f-port"), str(port))
    hands.press(page.get_by_role("button", name="Test the connection"))
    found = page.locator("#drive-check")
    expect(found).to_contain_text("The device answers")
    expect(found).to_contain_text("0.5 s, read back from the drive")
    expect(found).to_contain_text("Both axes ramp down and remain at standstill")
    hands.press(found.locator("summary"))
    expect(found.locator("tbody tr").first).to_contain_text("18512")
    found.scroll_into_view_if_needed()
    picture(page, f"drive-test-{name}")
    hands.press(page.get_by_role("button", name="Save the drive settings"))
    page.wait_for_url(re.compile("done=saved"))
    expect(page.locator("#f-port")).to_have_value(str(port))
    expect(page.get_by_role("button", name="Undo the last change of the drive")).to_be_visible()


def state(page: Page, proof: str, row: int = 0) -> Locator:
    return page.locator(f"#proof-{proof} .proof-states > li").nth(row)


def check_direction(page: Page, hands: Hands, picture: Picture, name: str) -> None:
    hands.press(page.get_by_role("button", name="Turn elevation by 3°"))
    expect(page.locator(".ask")).to_contain_text("tilt up, toward the sky?")
    picture(page, f"proof-direction-{name}")
    hands.press(page.get_by_role("button", name="Yes"))
    expect(state(page, "direction", 1)).to_have_attribute("data-status", "done")
    expect(state(page, "direction", 1)).to_contain_text(
        "The panel turned in the direction that the controller reports"
    )


def turn_round(page: Page, hands: Hands) -> None:
    hands.press(page.get_by_role("button", name="Turn azimuth by 3°"))
    hands.press(page.get_by_role("button", name="No, the other way"))
    expect(page.locator(".ask")).to_have_count(0)
    hands.press(page.get_by_role("button", name="Turn azimuth by 3°"))
    expect(page.locator(".ask")).to_be_visible()
    hands.press(page.get_by_role("button", name="Yes"))
    expect(state(page, "direction")).to_have_attribute("data-status", "done")


def check_scale(page: Page, hands: Hands) -> None:
    form = page.locator("#proof-scale")
    hands.press(form.get_by_role("button", name="Turn elevation"))
    hands.write(page.locator("#f-measured"), "12,5")
    hands.press(form.get_by_role("button", name="Confirm measurement"))
    expect(page.locator("#f-measured")).to_have_count(0)
    hands.press(form.get_by_role("button", name="Turn elevation"))
    hands.write(page.locator("#f-measured"), "10,1")
    hands.press(form.get_by_role("button", name="Confirm measurement"))
    expect(state(page, "scale", 1)).to_have_attribute("data-status", "done")
    expect(state(page, "scale", 1)).to_contain_text("10.10 degrees were measured")


def measure(page: Page, hands: Hands, picture: Picture, name: str) -> None:
    hands.press(page.get_by_role("button", name="Elevation, jog speed"))
    expect(state(page, "stop", 2)).to_contain_text(re.compile(r"was at standstill 0\.\d\d s"))
    hands.press(page.get_by_role("button", name="Test with elevation"))
    expect(page.locator(".strip-activity")).to_contain_text("Communication-loss test")
    expect(state(page, "link-loss")).to_contain_text(re.compile(r"slowed down after 0\.[4-7]\d s"))
    expect(state(page, "link-loss")).to_have_attribute("data-status", "done")
    page.locator("#proof-link-loss").scroll_into_view_if_needed()
    picture(page, f"proof-measured-{name}")


def set_limits(page: Page, hands: Hands) -> None:
    expect(page.locator("#limits [data-action]").first).to_be_disabled()
    expect(page.locator('#limits [data-reasons="set_limit"]')).to_contain_text("is not homed")
    page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
    reading = page.locator('.jog-panel [data-live="measured.elevation_deg"]')
    move_by_hand(hands, page.locator('[data-jog="elevation"][data-direction="1"]'), reading)


def arrive(page: Page, hands: Hands, service: str, tracker_id: str) -> str:
    """Add a tracker that may be moved fast by hand, and return where its pages are."""
    add_tracker(page, hands, service, tracker_id)
    fast = {"azimuth": {"jog_fast_dps": 6.0}, "elevation": {"jog_fast_dps": 4.0}}
    assert httpx.patch(f"{service}/api/v1/trackers/{tracker_id}", json=fast).status_code == 200
    return f"{service}/trackers/{tracker_id}"


def test_a_drive_is_connected_and_proven_with_a_mouse(
    walker: Walker, service: str, sim_port: int, picture: Picture
) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    url = arrive(page, hands, service, "drive-mouse")
    connect(page, hands, url, sim_port, picture, "desk")
    opened(page, f"{url}/drive-tests")
    check_direction(page, hands, picture, "desk")
    turn_round(page, hands)
    check_scale(page, hands)
    measure(page, hands, picture, "desk")
    set_limits(page, hands)
    opened(page, f"{url}/record")
    picture(page, "record-proven-desk")
    record = httpx.get(f"{service}/api/v1/trackers/drive-mouse/record").json()
    assert record["tracker"]["drive"]["azimuth"]["inverted"] is True
    assert record["tracker"]["drive"]["elevation"]["gear_ratio"] == pytest.approx(0.8, rel=0.02)


def test_a_drive_is_connected_and_its_watchdog_tested_with_a_finger(
    walker: Walker, service: str, sim_port: int, picture: Picture
) -> None:
    page = walker("phone", "finger")
    hands = Finger(page)
    url = arrive(page, hands, service, "drive-finger")
    connect(page, hands, url, sim_port, picture, "phone")
    opened(page, f"{url}/drive-tests")
    check_direction(page, hands, picture, "phone")
    measure(page, hands, picture, "phone")
