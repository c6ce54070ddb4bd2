"""What people meet at the door: log-in and its sentences, a cabinet's panel, Stop after a session ended."""

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect

from app.access.accounts import TokenWish
from app.access.authenticator import Keeper
from app.access.roles import Role
from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.browser.conftest import SIZES, Served, running
from tests.browser.page_clock import Stage
from tests.e2e.chromium import PAGE_READY
from tests.fake_data import NOON
from tests.fakes import FakeMachine, FakeReader
from tests.patience import PATIENCE_MS, PATIENCE_S
from tests.web.office import HERE, PASSWORD

PIN = "471108"
WRONG = "The name or the password is wrong."
PEOPLE = {"root": Role.ADMINISTRATOR, "ada": Role.OPERATOR, "vera": Role.VIEWER}


@dataclass
class Door:
    """A panel with users behind its door, and a browser before it."""

    context: BrowserContext
    served: Served
    clock: VirtualClock
    url: str

    @property
    def keeper(self) -> Keeper:
        assert self.served.app is not None
        keeper: Keeper = self.served.app.state.panel.keeper
        return keeper

    def do(self, work: Callable[[], Any]) -> Any:
        """Change something as the command line would, and have the panel know it."""
        assert self.served.loop is not None
        return asyncio.run_coroutine_threadsafe(self.keeper.do(work), self.served.loop).result(PATIENCE_S)

    def add(self, name: str, role: Role) -> None:
        """Add somebody, whose password is that of all."""
        self.do(lambda: self.keeper.accounts.add(HERE, name, {role}, PASSWORD, self.clock.now()))

    def end(self, name: str) -> None:
        """End every session of somebody."""
        for one in [one for one in self.keeper.book.sessions.values() if one.user == name]:
            self.do(lambda one=one: self.keeper.accounts.end_session(HERE, one.digest, self.clock.now()))

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
    clock, machine = VirtualClock(NOON), FakeMachine()
    settings = Settings(data_dir=Path(tmp_path_factory.mktemp("door")))
    app = create_app(settings, machine=machine, reader=FakeReader(), clock=clock, hasher=FakeHasher())
    context = browser.new_context()
    context.set_default_timeout(PATIENCE_MS)
    served = Served(machine, app)
    with running(served) as plant:
        door = Door(context, served, clock, plant.url)
        for name, role in PEOPLE.items():
            door.add(name, role)
        yield door
        context.close()


def sign_in(page: Page, name: str, password: str) -> None:
    page.get_by_label("Name", exact=True).fill(name)
    page.get_by_label("Password", exact=True).fill(password)
    with page.expect_navigation():
        page.get_by_role("button", name="Sign in").click()


def test_log_in_says_what_is_wrong_waits_and_leads_where_one_wanted_to_go(
    door: Door, picture: Callable[[Page, str], None]
) -> None:
    page = door.stranger("/trackers/T1", "tablet")
    for waited_s in (0, 0, 0, 2, 3, 5):
        door.passes(timedelta(seconds=waited_s))
        sign_in(page, "ada", "wrong horse battery")
        expect(page.get_by_role("alert").filter(has_text=WRONG)).to_be_visible()
        expect(page.get_by_label("Name", exact=True)).to_have_value("ada")
        expect(page.get_by_label("Password", exact=True)).to_have_value("")
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
    park = page.locator('.slots form[action="/trackers/T1/park"]')
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
    with page.expect_response(lambda answer: answer.ok and answer.url.endswith("/park")):
        park.locator("button").click()
    assert ("park", "Cabinet north (kiosk)") in door.kinds()

    door.passes(timedelta(minutes=5, seconds=1))
    page.reload()
    expect(page.locator(".header-who")).to_contain_text("viewer")
    expect(park.locator("button")).to_be_disabled()


def test_stop_works_on_a_page_whose_session_was_ended(
    door: Door, picture: Callable[[Page, str], None]
) -> None:
    page = door.signed_in("vera", "/trackers/T1")
    door.end("vera")
    expect(page.locator("#link-words")).to_have_text("signed out")
    expect(page.locator("#link-banner-words")).to_contain_text("Your session has ended")
    page.locator("#stop-key").click()
    expect(page.locator("#stopped-words")).to_have_text("Stopped.")
    page.evaluate("scrollTo(0, 0)")
    picture(page, "session-ended")
    assert ("stop", "vera (stop ticket)") in door.kinds()


def test_the_network_page_says_where_to_go_and_counts_down(
    stage: Stage, picture: Callable[[Page, str], None]
) -> None:
    page = stage.open("/network")
    picture(page, "network")
    page.get_by_label("Address to listen on").fill("127.0.0.1")
    page.get_by_label("Port", exact=True).fill("8443")
    page.get_by_role("button", name="Try this").click()
    expect(page.get_by_role("heading", name="Heliopanel is switching to its new address.")).to_be_visible()
    expect(page.locator("[data-network-left]")).to_have_text("60 s")
    picture(page, "network-try")
    stage.advance(2_000)
    expect(page.locator("[data-network-left]")).to_have_text("58 s")
