"""Stop from any of eight tabs; what a page shows and does when the link is gone."""

import signal
import time
from collections.abc import Callable

import pytest

from app.tracker.settings.axes import AZIMUTH_DEFAULT
from tests.e2e.chromium import Chromium, Tab
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product
from tests.e2e.proxy import Network
from tests.fault_result import REAL, FaultResult
from tests.soak.rigs.eyes import Eyes

LIVE = "/trackers/T1"
HOMING = f"{LIVE}/commissioning/homing"
TABS = 8
RAMP_S = AZIMUTH_DEFAULT.speed_dps / AZIMUTH_DEFAULT.acceleration_dps2
STOP_WITHIN_S = 0.15
STALE_WITHIN_S = 2.0
TOO_OLD_S = 2.5
"""An order that is older than 2 s is refused."""
JOG_KEY = '[data-jog="azimuth"][data-direction="1"]'
STRIP = "document.querySelector('.says-state').textContent"
WATCH_LINK = """
window.links = [];
new MutationObserver(() => links.push([
  Date.now(), document.documentElement.dataset.link,
  document.querySelectorAll('[data-action]:not(:disabled)').length,
  document.getElementById('link-banner').hidden,
])).observe(document.documentElement, {attributes: true, attributeFilter: ['data-link']});
"""


@pytest.fixture(scope="module", autouse=True)
def commissioned(product: Product, drive: DriveSim) -> None:
    calling = Integrator(product.url)
    calling.commission(drive.port)
    calling.close()


def turn(integrator: Integrator, eyes: Eyes, *, by_deg: float) -> None:
    """Send the panel far away and return once it has turned by so much."""
    integrator.until_allowed("move")
    begun = eyes.now
    there = 20.0 if begun.azimuth_deg > 150.0 else 300.0
    integrator.command("move", azimuth_deg=there, elevation_deg=0.0)
    give_up = time.monotonic() + 5.0
    while abs(eyes.now.azimuth_deg - begun.azimuth_deg) < by_deg:
        assert time.monotonic() < give_up, "the panel does not turn"
        time.sleep(0.005)


def test_stop_from_any_of_eight_tabs(
    opened: Callable[..., Tab], integrator: Integrator, browser: Chromium, eyes: Eyes
) -> None:
    tabs = [opened(LIVE) for _ in range(TABS)]
    for tab in (tabs[-1], tabs[0], tabs[3]):
        browser.send("Target.activateTarget", targetId=tab.target)
        turn(integrator, eyes, by_deg=4.0)
        took_s = eyes.rest_after(tab.click("#stop-key"))
        print(f"at rest {(took_s - RAMP_S) * 1000:.0f} ms and its ramp after the click")
        assert took_s <= RAMP_S + STOP_WITHIN_S
    for tab in tabs:
        tab.until(
            f"document.documentElement.dataset.link === 'live' && {STRIP}.includes('At standstill')",
            "every tab shows it",
        )


def lost_after_s(tab: Tab, at_ms: float) -> float:
    """Return how long after an instant the page showed that its values are old and its keys were off."""
    tab.until("links.some(([, link]) => link !== 'live')", "the page shows that it is lost")
    shown = next(one for one in tab.evaluate("links") if one[1] != "live")
    assert shown[2] == 0, "keys that move still work"
    assert shown[3] is False, "no banner"
    return float(shown[0] - at_ms) / 1000.0


def watch_link(tab: Tab) -> None:
    tab.until("document.querySelectorAll('[data-action]:not(:disabled)').length > 0", "keys work")
    tab.until("(document.getElementById('link-quality')?.dataset.level ?? '1') !== '0'", "held keys do, too")
    tab.evaluate(WATCH_LINK)


@pytest.mark.fault(44)
@pytest.mark.fault(45)
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
@pytest.mark.parametrize(("child", "path"), [("controller", LIVE), ("web", HOMING)])
def test_lost_process_is_shown_within_two_seconds(
    child: str,
    path: str,
    number: signal.Signals,
    opened: Callable[..., Tab],
    product: Product,
    fault: FaultResult,
) -> None:
    tab = opened(path)
    watch_link(tab)
    at_ms = time.time() * 1000
    product.signal(child, number)
    took_s = lost_after_s(tab, at_ms)
    if number is signal.SIGSTOP:
        product.signal(child, signal.SIGCONT)
    print(f"{child} {number.name}: shown after {took_s:.2f} s")
    assert took_s <= STALE_WITHIN_S
    fault.noticed(took_s, REAL)
    fault.shows(tab.evaluate("document.getElementById('link-banner').innerText"))
    product.until_ready()
    tab.until("document.documentElement.dataset.link === 'live'", "the page is live again")
    tab.until("document.getElementById('link-banner').hidden", "the banner is gone")


def ask_for_motion(tab: Tab) -> None:
    """Fill in a direction and press Go, as somebody does who has not seen yet that the link is gone."""
    tab.evaluate(
        "for (const [name, value] of [['azimuth', '100'], ['elevation', '10']]) "
        "document.querySelector(`#go-form [name=${name}]`).value = value;"
    )
    tab.click("#go-form button")


def press_key_shortly(tab: Tab) -> None:
    at = tab.middle(JOG_KEY)
    tab.mouse("mouseMoved", at)
    tab.mouse("mousePressed", at)
    time.sleep(0.3)
    tab.mouse("mouseReleased", at)


@pytest.mark.parametrize(
    ("path", "press"), [(LIVE, ask_for_motion), (HOMING, press_key_shortly)], ids=["go", "hold"]
)
def test_frozen_link_is_shown_and_nothing_moves_late(
    path: str,
    press: Callable[[Tab], None],
    opened: Callable[..., Tab],
    cable: Network,
    integrator: Integrator,
    eyes: Eyes,
) -> None:
    integrator.until_allowed("move")
    tab = opened(path, cable.url)
    watch_link(tab)
    at_ms = time.time() * 1000
    at = cable.freeze()
    press(tab)
    took_s = lost_after_s(tab, at_ms)
    print(f"frozen link: shown after {took_s:.2f} s")
    assert took_s <= STALE_WITHIN_S
    press(tab)
    eyes.stays(at, TOO_OLD_S)
    eyes.stays(cable.thaw(), 1.0)
    tab.until("document.documentElement.dataset.link === 'live'", "the page is live again")
    eyes.stays(at, eyes.now.at - at)


def test_what_was_pressed_while_the_panel_was_dead_is_not_done_later(
    opened: Callable[..., Tab], product: Product, integrator: Integrator, eyes: Eyes
) -> None:
    integrator.until_allowed("move")
    tab = opened(LIVE)
    watch_link(tab)
    at_ms = time.time() * 1000
    at = product.signal("web", signal.SIGKILL)
    ask_for_motion(tab)
    lost_after_s(tab, at_ms)
    ask_for_motion(tab)
    product.until_ready()
    tab.until("document.documentElement.dataset.link === 'live'", "the page is live again")
    eyes.stays(at, eyes.now.at - at + 1.0)
    tab.until("!document.querySelector('#go-form button').disabled", "a motion may be asked for")
    ask_for_motion(tab)
    eyes.until_moving(within_s=15.0)
    integrator.post("/stop")
    eyes.rest_after(time.monotonic())
