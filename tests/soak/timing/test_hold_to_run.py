"""Hold-to-run from a real browser to a drive behind Modbus TCP: every way of letting go, measured there."""

import signal
import time
from collections.abc import Callable, Iterator

import pytest

from app.tracker.settings.axes import AZIMUTH_DEFAULT
from tests.e2e.chromium import Chromium, Tab, chromium
from tests.e2e.integrator import Integrator
from tests.e2e.product import DriveSim, Product
from tests.e2e.proxy import Network, network
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
STAYS_S = 0.4


@pytest.fixture(scope="module")
def browser() -> Iterator[Chromium]:
    with chromium() as started:
        yield started


@pytest.fixture(scope="module")
def ready(product: Product, drive: DriveSim) -> Product:
    calling = Integrator(product.url)
    calling.connect(drive.port)
    calling.close()
    return product


@pytest.fixture
def opened(ready: Product, browser: Chromium) -> Iterator[Callable[..., Tab]]:
    tabs: list[Tab] = []

    def open_page(url: str = ready.url, path: str = HOMING) -> Tab:
        tab = browser.tab(url + path)
        tabs.append(tab)
        prepare(tab)
        return tab

    yield open_page
    for tab in tabs:
        if any(one["targetId"] == tab.target for one in browser.send("Target.getTargets")["targetInfos"]):
            tab.close()


def prepare(tab: Tab) -> None:
    """Wait until the key may be pressed and begins something, and choose the fast speed."""
    tab.until(f"!document.querySelector({KEY!r}).disabled", "the key may be pressed")
    tab.until(
        "'12'.includes(document.getElementById('link-quality').dataset.level)", "the link is fast enough"
    )
    tab.evaluate("document.querySelector('input[name=speed][value=fast]').click()")


def hold(tab: Tab, eyes: Eyes) -> None:
    """Press the key with the mouse until the axis turns at its full speed."""
    begun = eyes.now
    at = tab.middle(KEY)
    tab.mouse("mouseMoved", at)
    tab.mouse("mousePressed", at)
    at_speed(eyes, begun.azimuth_deg)


def at_speed(eyes: Eyes, begun_deg: float) -> None:
    give_up = time.monotonic() + 5.0
    while eyes.now.azimuth_deg < begun_deg + AT_SPEED_DEG:
        assert time.monotonic() < give_up, "the axis does not turn"
        time.sleep(0.005)


def comes_to_rest(eyes: Eyes, fault_at: float, *, more_s: float = 0.0) -> float:
    """Return when the axis was at rest after a fault; fail unless that is in time and it stays there."""
    took_s = eyes.rest_after(fault_at)
    print(f"at rest after {took_s * 1000:.0f} ms, ramp {RAMP_S * 1000:.0f} ms included")
    assert took_s <= PROMISED_S + RAMP_S + more_s
    stays(eyes, fault_at + took_s)
    return took_s


def stays(eyes: Eyes, since: float) -> None:
    until = time.monotonic() + STAYS_S
    while eyes.now.at < until:
        time.sleep(0.02)
    assert not eyes.moved_after(since + 0.01)


def test_pointer_released(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    hold(tab, eyes)
    at = time.monotonic()
    tab.mouse("mouseReleased", tab.middle(KEY))
    comes_to_rest(eyes, at)


def test_pointer_slid_off_the_key(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    hold(tab, eyes)
    at = time.monotonic()
    tab.mouse("mouseMoved", (5.0, 5.0))
    comes_to_rest(eyes, at)


@pytest.mark.fault(57)
def test_tab_closed(opened: Callable[..., Tab], eyes: Eyes, fault: FaultResult) -> None:
    tab = opened()
    hold(tab, eyes)
    at = time.monotonic()
    tab.close()
    fault.noticed(comes_to_rest(eyes, at), REAL)
    fault.shows_nothing("the page is gone")


def test_page_left(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    hold(tab, eyes)
    at = time.monotonic()
    tab.send("Page.navigate", url="about:blank")
    comes_to_rest(eyes, at)


@pytest.mark.fault(58)
def test_page_put_out_of_sight(
    opened: Callable[..., Tab], browser: Chromium, eyes: Eyes, fault: FaultResult
) -> None:
    tab = opened()
    hold(tab, eyes)
    window = browser.send("Browser.getWindowForTarget", targetId=tab.target)["windowId"]
    at = time.monotonic()
    browser.send("Browser.setWindowBounds", windowId=window, bounds={"windowState": "minimized"})
    fault.noticed(comes_to_rest(eyes, at), REAL)
    assert tab.evaluate("document.visibilityState") == "hidden"
    browser.send("Browser.setWindowBounds", windowId=window, bounds={"windowState": "normal"})


def test_second_finger(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    tab.send("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    begun = eyes.now
    one, two = tab.middle(KEY), tab.middle(OTHER_KEY)
    tab.fingers("touchStart", one)
    at_speed(eyes, begun.azimuth_deg)
    at = time.monotonic()
    tab.fingers("touchStart", one, two)
    comes_to_rest(eyes, at)


def test_finger_lifted(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    tab.send("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)
    begun = eyes.now
    tab.fingers("touchStart", tab.middle(KEY))
    at_speed(eyes, begun.azimuth_deg)
    at = time.monotonic()
    tab.fingers("touchEnd")
    comes_to_rest(eyes, at)


def test_keyboard_key_released(opened: Callable[..., Tab], eyes: Eyes) -> None:
    tab = opened()
    begun = eyes.now
    tab.evaluate(f"document.querySelector({KEY!r}).focus()")
    tab.key("keyDown", *SPACE)
    at_speed(eyes, begun.azimuth_deg)
    at = time.monotonic()
    tab.key("keyUp", *SPACE)
    comes_to_rest(eyes, at)


def test_stop_pressed_in_another_tab(opened: Callable[..., Tab], ready: Product, eyes: Eyes) -> None:
    tab = opened()
    hold(tab, eyes)
    calling = Integrator(ready.url)
    at = time.monotonic()
    calling.post("/stop")
    comes_to_rest(eyes, at)
    calling.close()


@pytest.fixture
def cable(ready: Product) -> Iterator[Network]:
    with network(ready.port) as laid:
        yield laid


def test_network_cut_while_the_key_is_held(opened: Callable[..., Tab], cable: Network, eyes: Eyes) -> None:
    tab = opened(cable.url)
    hold(tab, eyes)
    comes_to_rest(eyes, cable.freeze())
    stays(eyes, cable.thaw())


def test_network_cut_and_the_key_released_behind_it(
    opened: Callable[..., Tab], cable: Network, eyes: Eyes
) -> None:
    tab = opened(cable.url)
    hold(tab, eyes)
    at = cable.freeze()
    tab.mouse("mouseReleased", tab.middle(KEY))
    comes_to_rest(eyes, at)
    stays(eyes, cable.thaw())


def test_short_freeze_does_not_revive_the_press(
    opened: Callable[..., Tab], cable: Network, eyes: Eyes
) -> None:
    tab = opened(cable.url)
    hold(tab, eyes)
    at = cable.freeze()
    time.sleep(0.4)
    cable.thaw()
    comes_to_rest(eyes, at)


def test_browser_killed(ready: Product, eyes: Eyes) -> None:
    with chromium() as own:
        tab = own.tab(ready.url + HOMING)
        prepare(tab)
        hold(tab, eyes)
        comes_to_rest(eyes, own.signal(signal.SIGKILL))


def test_browser_frozen(ready: Product, eyes: Eyes) -> None:
    with chromium() as own:
        tab = own.tab(ready.url + HOMING)
        prepare(tab)
        hold(tab, eyes)
        comes_to_rest(eyes, own.signal(signal.SIGSTOP))
        stays(eyes, own.signal(signal.SIGCONT))


def test_web_process_frozen(opened: Callable[..., Tab], ready: Product, eyes: Eyes) -> None:
    hold(opened(), eyes)
    comes_to_rest(eyes, ready.signal("web", signal.SIGSTOP))
    stays(eyes, ready.signal("web", signal.SIGCONT))


def test_web_process_killed(opened: Callable[..., Tab], ready: Product, eyes: Eyes) -> None:
    hold(opened(), eyes)
    comes_to_rest(eyes, ready.signal("web", signal.SIGKILL))
    ready.until_ready()
    stays(eyes, eyes.now.at)


def test_machine_process_frozen(opened: Callable[..., Tab], ready: Product, eyes: Eyes) -> None:
    hold(opened(), eyes)
    comes_to_rest(eyes, ready.signal("controller", signal.SIGSTOP), more_s=WATCHDOG_S)
    stays(eyes, ready.signal("controller", signal.SIGCONT))


def test_machine_process_killed(opened: Callable[..., Tab], ready: Product, eyes: Eyes) -> None:
    hold(opened(), eyes)
    at = ready.signal("controller", signal.SIGKILL)
    comes_to_rest(eyes, at, more_s=WATCHDOG_S)
    ready.until_ready()
    stays(eyes, at + PROMISED_S + RAMP_S + WATCHDOG_S)
