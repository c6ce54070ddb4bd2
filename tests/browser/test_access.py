"""What people meet at the door: log-in and its sentences, a cabinet's panel, Stop after a session ended."""

import asyncio
import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from app.access.accounts import TokenWish
from app.access.authenticator import Keeper
from app.access.roles import Role, who_may
from app.base.clock import VirtualClock
from app.base.message import say
from app.base.permission import Permission
from app.base.settings import Settings
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.browser.conftest import SIZES, Served
from tests.browser.page_clock import Stage
from tests.e2e.chromium import PAGE_READY
from tests.fake_alarms import alarm
from tests.fake_data import NOON
from tests.fakes import FakeMachine, FakeReader
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.web.office import HERE, PASSWORD

PIN = "471108"
WRONG = "The name or the password is wrong."


@dataclass
class Door:
    """A panel with users behind its door, and a browser before it."""

    context: BrowserContext
    served: Served
    clock: VirtualClock

    @property
    def url(self) -> str:
        assert self.served.server is not None
        return f"http://127.0.0.1:{self.served.server.servers[0].sockets[0].getsockname()[1]}"

    @property
    def keeper(self) -> Keeper:
        assert self.served.app is not None
        keeper: Keeper = self.served.app.state.panel.keeper
        return keeper

    def do(self, work: Callable[[], Any]) -> Any:
        """Change something as the command line would, and have the panel know it."""
        assert self.served.loop is not None
        return asyncio.run_coroutine_threadsafe(self.keeper.do(work), self.served.loop).result(PATIENCE_S)

    def passes(self, time: timedelta) -> None:
        """Let time pass for the panel."""
        self.do(lambda: self.clock.advance(time))

    def stranger(self, path: str, size: str = "desk") -> Page:
        """Open a page in a browser in which nobody has signed in."""
        width, height = SIZES[size]
        self.context.clear_cookies()
        for page in self.context.pages:
            page.close()
        page = self.context.new_page()
        page.set_viewport_size({"width": width, "height": height})
        page.goto(self.url + path)
        return page

    def signed_in(self, name: str, path: str, size: str = "desk") -> Page:
        """Sign in by hand and open a page."""
        page = self.stranger(f"/login?back={path}", size)
        sign_in(page, name, PASSWORD)
        page.wait_for_selector(PAGE_READY)
        return page

    def kinds(self) -> list[tuple[str, str]]:
        """Return kind and actor of every order that reached the machine."""
        return [(one.command.kind, one.actor) for one in list(self.served.machine.orders)]


@pytest.fixture(scope="module")
def door(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Door]:
    clock = VirtualClock(NOON)
    machine, settings = FakeMachine(), Settings(data_dir=Path(tmp_path_factory.mktemp("door")))
    app = create_app(settings, machine=machine, reader=FakeReader(), clock=clock, hasher=FakeHasher())
    served = Served(machine, app)
    thread = threading.Thread(target=lambda: asyncio.run(served.run()), daemon=True)
    thread.start()
    assert served.ready.wait(PATIENCE_S), "the panel did not start"
    assert served.server is not None
    context = browser.new_context()
    context.set_default_timeout(PATIENCE_MS)
    door = Door(context, served, clock)
    for role in (Role.ADMINISTRATOR, Role.OPERATOR, Role.VIEWER):
        name, now = {"administrator": "root", "operator": "ada", "viewer": "vera"}[role], clock.now()
        door.do(
            lambda name=name, role=role, now=now: door.keeper.accounts.add(HERE, name, {role}, PASSWORD, now)
        )
    yield door
    context.close()
    served.server.should_exit = True
    thread.join(PATIENCE_S)
    assert not thread.is_alive(), "the panel did not stop"


def sign_in(page: Page, name: str, password: str) -> None:
    page.get_by_label("Name", exact=True).fill(name)
    page.get_by_label("Password", exact=True).fill(password)
    with page.expect_navigation():
        page.get_by_role("button", name="Sign in").click()


def test_log_in_says_what_is_wrong_waits_and_leads_where_one_wanted_to_go(
    door: Door, picture: Callable[[Page, str], None]
) -> None:
    page = door.stranger("/trackers/T1", "tablet")
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()
    for _ in range(3):
        sign_in(page, "ada", "wrong horse battery")
        expect(page.get_by_role("alert").filter(has_text=WRONG)).to_be_visible()
        expect(page.get_by_label("Name", exact=True)).to_have_value("ada")
        expect(page.get_by_label("Password", exact=True)).to_have_value("")
    for waited_s in (2, 3, 5):
        door.passes(timedelta(seconds=waited_s))
        sign_in(page, "ada", "wrong horse battery")
        expect(page.get_by_role("alert").filter(has_text=WRONG)).to_be_visible()
    sign_in(page, "ada", PASSWORD)
    expect(page.get_by_role("alert").filter(has_text="Wait 8 s, then try again.")).to_be_visible()
    picture(page, "log-in-wait")
    door.passes(timedelta(seconds=9))
    sign_in(page, "ada", PASSWORD)
    page.wait_for_url("**/trackers/T1")
    expect(page.locator(".header-who b")).to_have_text("ada")


def test_a_cabinets_panel_stops_steps_up_by_its_pin_and_steps_down_again(
    door: Door, picture: Callable[[Page, str], None]
) -> None:
    wish, now = TokenWish("Cabinet north", pin=PIN, lifetime=timedelta(days=90)), door.clock.now()
    token = door.do(lambda: door.keeper.accounts.mint(HERE, wish, now))
    page = door.stranger("/kiosk", "tablet")
    page.get_by_label("Token of this cabinet").fill(token)
    page.get_by_role("button", name="Bind this display").click()
    page.wait_for_url(f"{door.url}/")
    page.goto(f"{door.url}/trackers/T1")
    expect(page.locator(".header-who")).to_contain_text("viewer")
    park = page.locator('form[action="/trackers/T1/park"]')
    expect(park).to_contain_text("Only for operator or engineer.")
    expect(park.locator("button")).to_be_disabled()
    page.locator("#stop-key").click()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    assert ("stop", "Cabinet north (kiosk)") in door.kinds()

    page.locator(".header-who").click()
    page.get_by_label("PIN").fill("000000")
    page.get_by_role("button", name="Operate for 5 minutes").click()
    expect(page.get_by_role("alert").filter(has_text="The PIN is wrong.")).to_be_visible()
    page.get_by_label("PIN").fill(PIN)
    picture(page, "kiosk-pin")
    page.get_by_role("button", name="Operate for 5 minutes").click()
    page.wait_for_url(f"{door.url}/")
    page.goto(f"{door.url}/trackers/T1")
    expect(page.locator(".header-who")).to_contain_text("operator until")
    page.locator('form[action="/trackers/T1/park"] button').click()
    expect(park.locator(".outcome-ok")).to_be_visible()
    assert ("park", "Cabinet north (kiosk)") in door.kinds()

    door.passes(timedelta(minutes=5, seconds=1))
    page.reload()
    expect(page.locator(".header-who")).to_contain_text("viewer")
    expect(page.locator('form[action="/trackers/T1/park"] button')).to_be_disabled()


def test_stop_works_on_a_page_whose_session_was_ended(
    door: Door, picture: Callable[[Page, str], None]
) -> None:
    page = door.signed_in("vera", "/trackers/T1")
    session = next(one for one in door.keeper.book.sessions.values() if one.user == "vera")
    now = door.clock.now()
    door.do(lambda: door.keeper.accounts.end_session(HERE, session.digest, now))
    expect(page.locator("#link-words")).to_have_text("signed out")
    expect(page.locator("#link-banner-words")).to_contain_text("Your session has ended")
    page.locator("#stop-key").click()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    page.evaluate("scrollTo(0, 0)")
    picture(page, "session-ended")
    assert ("stop", "vera (stop ticket)") in door.kinds()
    page.goto(f"{door.url}/trackers/T2")
    expect(page.get_by_role("heading", name="Sign in")).to_be_visible()


def test_the_network_page_says_where_to_go_and_counts_down(
    stage: Stage, picture: Callable[[Page, str], None]
) -> None:
    page = stage.open("/network", allow=("422",))
    picture(page, "network")
    page.get_by_label("Address to listen on").fill("somewhere")
    page.get_by_role("button", name="Try this").click()
    expect(page.locator(".summary-error")).to_contain_text("somewhere is not an IP address")
    page.get_by_label("Address to listen on").fill("127.0.0.1")
    page.get_by_label("Port", exact=True).fill("8443")
    page.get_by_role("button", name="Try this").click()
    expect(page.get_by_role("heading", name="Heliopanel is switching to its new address.")).to_be_visible()
    expect(page.locator("[data-network-left]")).to_have_text("60 s")
    picture(page, "network-try")
    stage.advance(2_000)
    expect(page.locator("[data-network-left]")).to_have_text("58 s")
    expect(page.locator("a.network-way")).to_have_count(1)


CUT_IN_STRIP = """() => {
  const strip = document.querySelector(".header").getBoundingClientRect();
  const inMessage = "#alarm-new :is(p, button > span, .alarm-first-words)";
  const parts = document.querySelectorAll(`#alarm-strip > *, ${inMessage}`);
  return [...parts].filter((one) => {
    const style = getComputedStyle(one);
    const box = one.getBoundingClientRect();
    const shown = one.checkVisibility({ visibilityProperty: true }) && style.clipPath === "none";
    const beyond = box.bottom > strip.bottom || box.right > strip.right;
    return shown && (beyond || one.scrollHeight > one.clientHeight + 1);
  }).map((one) => one.textContent);
}"""
BROKEN_STATES = """() => [...document.querySelectorAll(".alarm-state")].filter((one) => {
  const line = parseFloat(getComputedStyle(one).lineHeight);
  return one.textContent.trim().length < 6 && one.getBoundingClientRect().height > 1.5 * line;
}).map((one) => one.textContent.trim())"""


def test_a_viewer_reads_in_full_who_may_acknowledge_an_alarm(door: Door) -> None:
    """The words of each language are put into one page."""
    machine = door.served.machine
    machine.alarms = tuple(alarm(code, machine.clock.now()) for code in ("not_stowed", "drive_lost"))
    wanted = say("Only for {needed}.", needed=who_may(Permission.OPERATE))
    page = door.signed_in("vera", "/alarms")
    expect(page.locator("#alarm-ack button")).to_be_disabled()
    denied = page.locator(".denied-why")
    expect(page.locator("li.alarm .denied-why").first).to_have_text(str(wanted))
    for size in ("phone", "tablet"):
        page.set_viewport_size(dict(zip(("width", "height"), SIZES[size], strict=True)))
        for language in LANGUAGES:
            denied.evaluate_all(
                "(all, words) => all.forEach((one) => { one.textContent = words; })",
                catalogue_of(language).said(wanted),
            )
            assert page.evaluate(CUT_IN_STRIP) == [], (size, language)
            assert page.evaluate(BROKEN_STATES) == [], (size, language)
            why = page.locator("li.alarm .denied-why").first
            assert why.evaluate("one => one.scrollWidth <= one.clientWidth"), (size, language)
    machine.alarms = ()
