"""The real service, `heliopanel serve` with a simulated tracker, and a technician who walks its steps."""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from tests.browser.conftest import PATIENCE_MS, SIZES
from tests.browser.hands import Hands, arrive
from tests.ports import free_port

READY_S = 60
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


Walker = Callable[[str, str], Page]


@pytest.fixture(scope="module")
def rooms(browser: Browser) -> Iterator[dict[bool, BrowserContext]]:
    """A browser without and one with a touch screen, which keep what the pages of the service share."""
    contexts = {touch: browser.new_context(has_touch=touch, locale="en-GB") for touch in (False, True)}
    for context in contexts.values():
        context.set_default_timeout(PATIENCE_MS)
    yield contexts
    for context in contexts.values():
        context.close()


@pytest.fixture
def walker(rooms: dict[bool, BrowserContext]) -> Iterator[Walker]:
    """Open an empty page of a size for a hand; nothing may be complained of in its console."""
    complaints: list[str] = []
    pages: list[Page] = []

    def start(size: str, hand: str) -> Page:
        width, height = SIZES[size]
        page = rooms[hand == "finger"].new_page()
        pages.append(page)
        page.set_viewport_size({"width": width, "height": height})
        page.on("console", lambda one: complaints.append(one.text) if one.type == "error" else None)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        return page

    yield start
    for page in pages:
        page.close()
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
