"""Two operators fight for a tracker: what the one who lost control had sent moves nothing, however late."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Browser, Page, Route

from app.access.principal import this_computer
from app.access.roles import Role
from app.tracker.state.snapshot import ActivityName, EventKind
from tests.browser.hands import LINK_MEASURED, middle
from tests.browser.page_clock import BEAT_MS
from tests.browser.site_stage import SiteStage, staged_site
from tests.browser.test_jog_stays import BOXES

HOMING = "/trackers/T1/commissioning/homing"
KEY = '[data-jog="azimuth"][data-direction="1"]'
PASSWORD = "violet-anvil-harbour-9"  # noqa: S105 - of people who do not exist
NEEDS_OPERATOR = "Jogging needs the role operator. An administrator can add it under Users."
COUNTDOWN_MS = 10_000
HELD_MS = 200
LATE = """() => {
  const epoch = document.querySelector('input[name="epoch"]').value;
  const headers = { "HX-Request": "true", "X-CSRF-Token": document.documentElement.dataset.csrf };
  const body = new URLSearchParams({ increment: "azimuth +1", key: "late", epoch });
  fetch("/trackers/T1/step", { method: "POST", headers, body }).catch(() => {});
}"""


def session(stage: SiteStage, name: str, *roles: Role) -> str:
    """Add somebody, and return the id of a session of theirs."""
    assert stage.served.app is not None
    keeper, here, now = stage.served.app.state.panel.keeper, this_computer("127.0.0.1"), stage.clock.now()
    stage.ask(keeper.do(lambda: keeper.accounts.add(here, name, set(roles), PASSWORD, now)))
    return str(stage.ask(keeper.log_in(name, PASSWORD, "127.0.0.1", "test")))


def opened(stage: SiteStage, session: str, path: str = HOMING) -> Page:
    visitor, port = stage.visitor(), stage.plant.url.rpartition(":")[2]
    visitor.add_cookies([{"name": f"heliopanel-{port}", "value": session, "url": stage.plant.url}])
    return stage.visit(visitor, path)


def hold(stage: SiteStage, page: Page) -> None:
    """Press the key, and have the axis move."""
    stage.until(lambda: page.locator(LINK_MEASURED).count() and page.locator(KEY).is_enabled())
    page.mouse.move(*middle(page.locator(KEY)))
    page.mouse.down()
    stage.advance(HELD_MS)
    assert stage.tracker.activity is ActivityName.JOGGING


def control(stage: SiteStage, page: Page, state: str) -> int:
    return stage.until(lambda: page.locator("#control").get_attribute("data-state") == state)


@pytest.mark.fault(55)
@pytest.mark.fault(56)
def test_nothing_that_the_loser_sent_is_carried_out(
    browser: Browser, picture: Callable[[Page, str], None]
) -> None:
    with staged_site(browser) as stage:
        stage.allowed.append("Failed to load resource")
        session(stage, "root", Role.ADMINISTRATOR)
        ada, bo = [
            opened(stage, session(stage, name, Role.OPERATOR, Role.ENGINEER)) for name in ("ada", "bo")
        ]
        hold(stage, ada)
        ada.mouse.up()
        control(stage, ada, "mine")
        control(stage, bo, "held")
        bo.locator("#control > summary").click()
        bo.locator(".control-take summary").click()
        bo.fill("#control-reason", "I stand at the machine")
        picture(bo, "control-take")
        bo.get_by_role("button", name="Take over").click()
        asked_at = stage.clock.now()
        control(stage, ada, "wished")
        picture(ada, "control-wished")

        hold(stage, ada)
        waiting: list[Route] = []
        ada.route("**/*", lambda route: waiting.append(route))
        ada.evaluate("tap.freeze(); tap.excuse('')")
        stage.advance(HELD_MS)
        ada.mouse.up()
        ada.evaluate(LATE)
        stage.beat_ms = 5 * BEAT_MS
        control(stage, bo, "mine")
        assert (stage.clock.now() - asked_at).total_seconds() * 1000 <= COUNTDOWN_MS + stage.beat_ms
        assert stage.tracker.activity is ActivityName.HOLDING
        place, told = stage.tracker.measured, len(stage.served.events)

        before = stage.ask(stage.plant.machine.metrics()).orders_refused
        stage.beat_ms = BEAT_MS
        ada.evaluate("tap.thaw()")
        for route in waiting:
            route.continue_()
        assert [one for one in waiting if one.request.url.endswith("/step")]
        stage.until(lambda: stage.ask(stage.plant.machine.metrics()).orders_refused > before)
        stage.advance(500)
        assert (stage.tracker.measured, stage.speed_dps) == (place, 0.0)
        assert not [one for one in stage.served.events[told:] if one.kind is EventKind.JOG_STARTED]
        hold(stage, bo)
        bo.mouse.up()
        control(stage, ada, "held")
        picture(ada, "control-held")


@pytest.mark.parametrize("path", [HOMING, "/trackers/T1/mast"])
def test_who_may_not_jog_finds_the_buttons_in_their_place_and_reads_why(browser: Browser, path: str) -> None:
    with staged_site(browser) as stage:
        session(stage, "root", Role.ADMINISTRATOR)
        pages = {}
        for role in (Role.OPERATOR, Role.ADMINISTRATOR, Role.VIEWER):
            pages[role] = opened(stage, session(stage, f"a-{role.value}", role), path)
        places = {role: page.evaluate(BOXES) for role, page in pages.items()}
        for role in (Role.ADMINISTRATOR, Role.VIEWER):
            page, key = pages[role], pages[role].locator(KEY)
            assert places[role] == places[Role.OPERATOR]
            assert key.evaluate("e => getComputedStyle(e).borderStyle") == "dashed"
            assert key.get_attribute("aria-disabled") == "true"
            for act in (key.focus, lambda key=key: key.click(force=True)):
                page.evaluate("document.getElementById('jog-words').textContent = ''")
                act()
                assert page.locator("#jog-words").inner_text() == NEEDS_OPERATOR
                page.evaluate("document.activeElement.blur()")
            stage.advance(500)
            assert page.evaluate(BOXES) == places[role]
            assert page.locator("#jog-words a").count() == (1 if role is Role.ADMINISTRATOR else 0)
        assert stage.plant.orders("jog") == []
