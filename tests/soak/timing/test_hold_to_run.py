"""Hold-to-run from a real browser to a drive behind Modbus TCP: every way of letting go, measured there."""

import signal
import time
from collections.abc import Callable, Iterator

import pytest

from app.tracker.settings.axes import AZIMUTH_DEFAULT
from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product
from tests.e2e.proxy import Network
from tests.fault_result import REAL, FaultResult
from tests.soak.rigs.eyes import Eyes

HOMING = "/trackers/T1/commissioning/homing"
KEY = '[data-jog="azimuth"][data-direction="1"]'
OTHER_KEY = '[data-jog="elevation"][data-direction="1"]'
SPACE = (" ", "Space", 32)
PROMISED_S = 0.3
WATCHDOG_S = 0.5
RAMP_S = AZIMUTH_DEFAULT.jog_fast_dps / AZIMUTH_DEFAULT.acceleration_dps2
AT_SPEED_DEG = 1.2
"""After this angle the axis turns at its full speed."""
STAYS_S = 0.6
Open = Callable[..., Tab]


@pytest.fixture(scope="module", autouse=True)
def connected(product: Product, drive: DriveSim) -> None:
    calling = Integrator(product.url)
    calling.connect(drive.port)
    calling.close()


@pytest.fixture
def tab(opened: Open) -> Tab:
    return prepared(opened(HOMING))


def prepared(tab: Tab) -> Tab:
    """Wait until the key may be pressed and begins something, and choose the fast speed."""
    tab.until(f"!document.querySelector({KEY!r}).disabled", "the key may be pressed")
    tab.until(
        "'12'.includes(document.getElementById('link-quality').dataset.level)", "the link is fast enough"
    )
    tab.evaluate("document.querySelector('input[name=speed][value=fast]').click()")
    return tab


def press_pointer(tab: Tab) -> None:
    at = tab.middle(KEY)
    tab.mouse("mouseMoved", at)
    tab.mouse("mousePressed", at)


def press_finger(tab: Tab) -> None:
    tab.send("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    tab.fingers("touchStart", tab.middle(KEY))


def press_space(tab: Tab) -> None:
    tab.evaluate(f"document.querySelector({KEY!r}).focus()")
    tab.key("keyDown", *SPACE)


def hold(tab: Tab, eyes: Eyes, press: Callable[[Tab], None] = press_pointer) -> None:
    """Press the key until the axis turns at its full speed."""
    begun_deg, give_up = eyes.now.azimuth_deg, time.monotonic() + 5.0
    press(tab)
    while eyes.now.azimuth_deg < begun_deg + AT_SPEED_DEG:
        assert time.monotonic() < give_up, "the axis does not turn"
        time.sleep(0.005)


def comes_to_rest(eyes: Eyes, fault_at: float, *, more_s: float = 0.0) -> float:
    """Return when the axis was at rest after a fault; fail unless that is in time and it stays there."""
    took_s = eyes.rest_after(fault_at)
    print(f"at rest after {took_s * 1000:.0f} ms, ramp {RAMP_S * 1000:.0f} ms included")
    assert took_s <= PROMISED_S + RAMP_S + more_s
    eyes.stays(fault_at + took_s, STAYS_S)
    return took_s


def lift(tab: Tab) -> None:
    tab.mouse("mouseReleased", tab.middle(KEY))


WAYS: dict[str, tuple[Callable[[Tab], None], Callable[[Tab], object]]] = {
    "pointer released": (press_pointer, lift),
    "pointer slid off the key": (press_pointer, lambda tab: tab.mouse("mouseMoved", (5.0, 5.0))),
    "page left": (press_pointer, lambda tab: tab.send("Page.navigate", url="about:blank")),
    "second finger": (
        press_finger,
        lambda tab: tab.fingers("touchStart", tab.middle(KEY), tab.middle(OTHER_KEY)),
    ),
    "finger lifted": (press_finger, lambda tab: tab.fingers("touchEnd")),
    "keyboard key released": (press_space, lambda tab: tab.key("keyUp", *SPACE)),
}


@pytest.mark.parametrize("way", WAYS)
def test_a_key_let_go(tab: Tab, eyes: Eyes, way: str) -> None:
    press, let_go = WAYS[way]
    hold(tab, eyes, press)
    at = time.monotonic()
    let_go(tab)
    comes_to_rest(eyes, at)


@pytest.mark.fault(57)
def test_tab_closed(tab: Tab, eyes: Eyes, fault: FaultResult) -> None:
    hold(tab, eyes)
    at = time.monotonic()
    tab.close()
    fault.noticed(comes_to_rest(eyes, at), REAL)
    fault.shows_nothing("the page is gone")


@pytest.mark.fault(58)
def test_page_put_out_of_sight(tab: Tab, browser: Chromium, eyes: Eyes, fault: FaultResult) -> None:
    hold(tab, eyes)
    window = browser.send("Browser.getWindowForTarget", targetId=tab.target)["windowId"]
    at = time.monotonic()
    browser.send("Browser.setWindowBounds", windowId=window, bounds={"windowState": "minimized"})
    fault.noticed(comes_to_rest(eyes, at), REAL)
    assert tab.evaluate("document.visibilityState") == "hidden"
    browser.send("Browser.setWindowBounds", windowId=window, bounds={"windowState": "normal"})


def test_stop_pressed_in_another_tab(tab: Tab, integrator: Integrator, eyes: Eyes) -> None:
    hold(tab, eyes)
    at = time.monotonic()
    integrator.post("/stop")
    comes_to_rest(eyes, at)


@pytest.mark.parametrize("released", [False, True], ids=["held on", "released behind the cut"])
def test_network_cut(opened: Open, cable: Network, eyes: Eyes, released: bool) -> None:
    tab = prepared(opened(HOMING, cable.url))
    hold(tab, eyes)
    at = cable.freeze()
    if released:
        lift(tab)
    comes_to_rest(eyes, at)
    eyes.stays(cable.thaw(), STAYS_S)


def test_short_freeze_does_not_revive_the_press(opened: Open, cable: Network, eyes: Eyes) -> None:
    hold(prepared(opened(HOMING, cable.url)), eyes)
    at = cable.freeze()
    time.sleep(0.4)
    cable.thaw()
    comes_to_rest(eyes, at)


@pytest.fixture
def own() -> Iterator[Chromium]:
    with chromium() as started:
        yield started


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_browser_killed_or_frozen(
    own: Chromium, product: Product, eyes: Eyes, number: signal.Signals
) -> None:
    hold(prepared(own.tab(product.url + HOMING)), eyes)
    comes_to_rest(eyes, own.signal(number))
    if number is signal.SIGSTOP:
        eyes.stays(own.signal(signal.SIGCONT), STAYS_S)


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
@pytest.mark.parametrize(("child", "more_s"), [("web", 0.0), ("controller", WATCHDOG_S)])
def test_process_killed_or_frozen(
    tab: Tab, product: Product, eyes: Eyes, child: str, more_s: float, number: signal.Signals
) -> None:
    hold(tab, eyes)
    comes_to_rest(eyes, product.signal(child, number), more_s=more_s)
    since = eyes.now.at
    if number is signal.SIGSTOP:
        product.signal(child, signal.SIGCONT)
    product.until_ready()
    eyes.stays(since, STAYS_S)
