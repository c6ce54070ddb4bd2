"""A technician walks the five steps on the real service: `heliopanel serve` with a simulated tracker."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from tests.browser.conftest import PATIENCE_MS, SIZES
from tests.browser.hands import Finger, Hands, Keyboard, Mouse, arrive
from tests.ports import free_port

READY_S = 60
HANDS: dict[str, Callable[[Page], Hands]] = {"mouse": Mouse, "finger": Finger, "keyboard": Keyboard}
Picture = Callable[[Page, str], None]


@pytest.fixture(scope="module")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Run the whole service in a folder of its own and give its address."""
    folder, port = tmp_path_factory.mktemp("data"), free_port()
    env = os.environ | {"HELIOPANEL_DATA_DIR": str(folder), "HELIOPANEL_PORT": str(port)}
    command = [sys.executable, "-c", "from app.cli import main; main()", "serve"]
    root = Path(__file__).resolve().parents[2]
    with (folder / "log").open("wb") as log:
        process = subprocess.Popen(command, cwd=root, env=env, stdout=log, stderr=log)
        try:
            yield until_ready(f"http://127.0.0.1:{port}", folder / "log")
        finally:
            process.send_signal(signal.SIGTERM)
            process.wait(20)


def until_ready(url: str, log: Path) -> str:
    transport = httpx.HTTPTransport(retries=20)
    with httpx.Client(transport=transport, timeout=READY_S) as client:
        for _ in range(400):
            if client.get(f"{url}/api/v1/ready").status_code == 200:
                return url
    raise AssertionError(f"The service did not become ready: {log.read_text()[-2000:]}")


@pytest.fixture
def walker(browser: Browser) -> Iterator[Callable[[str, str], Page]]:
    complaints: list[str] = []
    contexts = []

    def start(size: str, hand: str) -> Page:
        width, height = SIZES[size]
        context = browser.new_context(
            viewport={"width": width, "height": height}, has_touch=hand == "finger", locale="en-GB"
        )
        contexts.append(context)
        context.set_default_timeout(PATIENCE_MS)
        page = context.new_page()
        page.on("console", lambda one: complaints.append(one.text) if one.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        return page

    yield start
    for context in contexts:
        context.close()
    assert complaints == []


def onwards(page: Page, hands: Hands, to: str) -> None:
    hands.press(page.locator("#forward .key"))
    arrive(page, to)


def add_tracker(page: Page, hands: Hands, url: str, tracker_id: str) -> None:
    page.goto(url)
    hands.write(page.locator("#f-tracker_id"), tracker_id)
    hands.write(page.locator("#f-name"), "Walked")
    hands.press(page.locator("#add-form button"))
    arrive(page, "/settings")


def say_where(page: Page, hands: Hands) -> None:
    hands.write(page.locator("#f-latitude"), "41° 17' 12,1\"")
    hands.write(page.locator("#f-longitude"), "36,33")
    expect(page.locator("#preview")).to_contain_text("Europe/Istanbul")
    onwards(page, hands, "/clock")


def trust_the_clock(page: Page, hands: Hands) -> None:
    hands.press(page.locator('form[action$="/clock/system"] button'))
    page.wait_for_selector("#forward a.key")
    onwards(page, hands, "/homing")


def home(page: Page, hands: Hands) -> None:
    reading = page.locator('[data-live="measured.azimuth_deg"]').first
    expect(reading).to_have_text(re.compile(r"\d"))
    before = reading.inner_text()
    hands.hold(page.locator('[data-jog="azimuth"][data-direction="1"]'))
    expect(reading).not_to_have_text(before)
    expect(page.locator('[data-action="zero"]')).to_be_enabled()
    hands.press(page.locator('[data-action="zero"]'))
    page.wait_for_selector("#forward a.key")
    expect(reading).to_have_text("0.00°")
    onwards(page, hands, "/mode")


def choose_dual(page: Page, hands: Hands) -> None:
    hands.choose(page.locator('input[value="dual"]'))
    onwards(page, hands, "/run")


def track(page: Page, hands: Hands) -> None:
    hands.press(page.locator('[data-action="track"]'))
    expect(page.locator(".strip-activity")).to_contain_text("Tracking")
    expect(page.locator('.step[data-current][data-status="done"]')).to_be_visible()


def commission(page: Page, hands: Hands, url: str, tracker_id: str) -> None:
    add_tracker(page, hands, url, tracker_id)
    page.goto(f"{url}/trackers/{tracker_id}/commissioning/location")
    page.wait_for_selector('html[data-link="live"]')
    say_where(page, hands)
    trust_the_clock(page, hands)
    home(page, hands)
    choose_dual(page, hands)
    track(page, hands)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("hand", HANDS)
def test_five_steps(
    hand: str, size: str, walker: Callable[[str, str], Page], service: str, picture: Picture
) -> None:
    page = walker(size, hand)
    commission(page, HANDS[hand](page), service, f"{hand}-{size}")
    picture(page, f"walk-{hand}-{size}")
    HANDS[hand](page).press(page.locator("#stop-key"))
    expect(page.locator(".strip-activity")).to_contain_text("Holding")


@pytest.mark.timeout(240)
def test_solstice_is_shown_and_replayed(
    walker: Callable[[str, str], Page], service: str, picture: Picture
) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    commission(page, hands, service, "shown")
    page.goto(f"{service}/trackers/shown/show")
    hands.press(page.get_by_role("link", name="21 June"))
    hands.write(page.locator("#f-minutes"), "0.2")
    expect(page.locator("#verdict:not([inert])")).to_contain_text("cannot be run")
    hands.press(page.locator("#verdict a.key-primary"))
    expect(page.locator("#verdict")).to_contain_text("This works")
    hands.press(page.locator('[data-action="go_to_start"]'))
    arrive(page, "/shows/.*")
    expect(page.locator("#show-phase")).to_have_text("Ready at the start", timeout=60000)
    hands.press(page.locator('[data-action="run_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Running")
    page.wait_for_timeout(15000)
    picture(page, "show-on-the-machine")
    hands.press(page.locator('[data-action="pause_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Paused")
    hands.press(page.locator('[data-action="stop_show"]'))
    expect(page.locator("#show-phase")).to_have_text("Ended")
    hands.press(page.get_by_role("link", name="Replay"))
    hands.press(page.locator(".list-row").first)
    expect(page.locator("#player-state")).to_have_text("")
    hands.press(page.locator("#player-play"))
    page.wait_for_timeout(2500)
    picture(page, "replay")
    assert float(page.locator("#player-scrubber").input_value()) > 1.0


def test_simulated_day_is_played(walker: Callable[[str, str], Page], service: str, picture: Picture) -> None:
    page = walker("desk", "mouse")
    hands = Mouse(page)
    page.goto(f"{service}/trackers/T1/commissioning/location")
    page.wait_for_selector('html[data-link="live"]')
    say_where(page, hands)
    page.goto(f"{service}/simulate")
    hands.write(page.locator("#f-date"), "2026-06-21")
    hands.press(page.locator("#simulate-form button"))
    page.wait_for_url(re.compile("/recordings/"), timeout=90000)
    expect(page.locator("#player-state")).to_have_text("")
    page.locator("#player-scrubber").fill("43200")
    picture(page, "simulated-day")
    expect(page.locator('[data-value="measured_elevation_deg"]')).to_have_text(re.compile(r"^[67]\d\."))
