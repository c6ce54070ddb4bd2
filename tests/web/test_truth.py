"""Each page of a tracker tells its state, its most urgent message, and why a button does not work."""

import re
from dataclasses import replace
from datetime import timedelta
from html import unescape
from itertools import cycle, islice, product

import httpx
import pytest

from app.access.roles import Role
from app.base.message import N_
from app.tracker.commands.control import ControlRequest, ControlState
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Pair, Snapshot
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import in_words
from app.web.shell.page_facts import told_in_page
from tests.every_state import AT, CASES, OPERATOR, StagedTracker, short_walk
from tests.fake_data import commissioned
from tests.fakes import FakeMachine
from tests.web.office import Office

T1 = "/trackers/T1"
PAGES = (T1, f"{T1}/commissioning/homing", f"{T1}/settings", f"{T1}/show", f"{T1}/mast")
OTHER_PAGES = (
    "/commissioning/location", "/commissioning/clock", "/commissioning/mode", "/commissioning/run", "/trends",
    "/sun-path", "/sun-check", "/record", "/protections", "/service", "/drive", "/drive-tests", "/strategy",
    "/mount", "/machine", "/fault-injection",
)  # fmt: skip
BAR = re.compile(
    r'<details class="says pop" id="says" data-code="(\w*)" data-priority="(\d*)">(.*?)</summary>', re.DOTALL
)
STATE = re.compile(r'data-live="state" data-form="words">([^<]*)<')
CARD = re.compile(
    r'id="urgent" role="alert" data-code="(\w*)" data-priority="\d*"( hidden)?>(.*?)</section>', re.DOTALL
)
FORM = re.compile(r"<form class=\"action\".*?</form>", re.DOTALL)
OFF = re.compile(r"<(button|fieldset)\b[^>]*\bdisabled")
WHY = re.compile(r'<ul class="reasons"[^>]*>\s*<li>|<p class="denied-why">')

VALID = re.compile(
    r'data-when="measured"( hidden)?>\s*<(?:div|span)\s[^>]*?data-when="homed(?:=true)?"( hidden)?>'
)


@pytest.fixture
def staged(machine: FakeMachine) -> StagedTracker:
    machine.trackers["T1"] = StagedTracker(
        commissioned("T1", "North field", tracking=False), Pair(180.0, 45.0)
    )
    return machine.trackers["T1"]


def seen(machine: FakeMachine) -> Snapshot:
    site = machine.latest()
    assert site is not None
    return site.trackers[0]


def check(text: str, word: str, tracker: Snapshot, *, live: bool, language: str = "en") -> None:
    """Fail unless a page tells the state and the most urgent message without a tap."""
    catalogue = catalogue_of(language)
    head, urgent = next(iter(tracker.messages), None), told_in_page(tracker)
    bar = BAR.search(text)
    assert bar is not None
    words = catalogue.gettext(in_words(word))
    assert set(map(unescape, STATE.findall(text))) == {words}, "every pill and the bar tell one state"
    assert bar[1] == (head.code if head else "")
    assert bar[2] == (str(min(one.priority for one in tracker.messages)) if head else "")
    if head is not None:
        told = head.message if head.code == word else head.title
        assert str(catalogue.said(told)) in unescape(re.sub(r"<[^>]*>", "", bar[3])), "in the bar"
    card = CARD.search(text)
    assert (card is not None) is live
    if card is not None:
        assert (card[2] is None) is (urgent is not None), "danger is told in the page itself"
        assert urgent is None or str(catalogue.said(urgent.title)) in unescape(card[3])
    assert '<p class="outcome-ok"' not in text, "no answer of a button contradicts the state"


@pytest.mark.parametrize("path", PAGES)
async def test_every_page_tells_the_state_and_what_is_most_urgent(
    path: str, client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    for name in CASES if path == T1 else short_walk():
        staged.case = CASES[name]
        machine.emit()
        text = (await client.get(path)).text
        check(text, CASES[name].word, seen(machine), live=path == T1)


@pytest.mark.parametrize("path", OTHER_PAGES)
async def test_so_does_every_other_page_of_a_tracker(
    path: str, client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    for name in ("tracking", "waiting", "fault", "silent drive while it holds", "not stowed"):
        staged.case = CASES[name]
        machine.emit()
        text = (await client.get(T1 + path)).text
        check(text, CASES[name].word, seen(machine), live=False)


async def test_it_is_told_in_the_language_of_the_page(
    client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    client.cookies.set("language", "de")
    for name in short_walk():
        staged.case = CASES[name]
        machine.emit()
        check((await client.get(T1)).text, CASES[name].word, seen(machine), live=True, language="de")


async def test_who_stopped_a_tracker_is_told_on_each_of_its_pages_until_something_else_happens(
    client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    machine.emit(Event(AT, EventKind.STOPPED, "T1", N_("North field was stopped."), "ada"))
    for path, name in product(PAGES, ("at standstill", "not stowed")):
        staged.case = CASES[name]
        machine.emit()
        bar = BAR.search((await client.get(path)).text)
        assert bar is not None
        assert bar[1] == ("not_stowed" if name == "not stowed" else "stopped")
        assert "Stopped by ada" in bar[3]
        assert re.search(r"\d\d:\d\d:\d\d", bar[3])
    staged.case = CASES["at standstill"]
    later = AT + timedelta(seconds=5)
    machine.emit(Event(later, EventKind.TRACKING_STARTED, "T1", N_("Tracking started, mode dual."), "zoe"))
    for path in PAGES:
        text = (await client.get(path)).text
        assert "Stopped by ada" not in text
        assert "Tracking started, mode dual. · zoe, " in text


async def test_a_home_position_is_not_called_valid_while_the_drive_is_silent(
    client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    for name, hidden in (("at standstill", False), ("silent drive while it holds", True)):
        staged.case = CASES[name]
        machine.emit()
        for path in (T1, f"{T1}/commissioning/homing"):
            found = VALID.search((await client.get(path)).text)
            assert found is not None
            assert (found[1] is not None) is hidden


async def test_tracking_is_ended_where_it_runs_and_started_everywhere_else(
    client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    for case in CASES.values():
        for tracking_on in (False, True):
            tracks = case.fields["activity"] is ActivityName.TRACKING
            staged.case = replace(case, fields=case.fields | {"tracking_on": tracking_on})
            machine.emit()
            slots = (await client.get(T1)).text.partition('class="slots"')[2]
            for path, hidden in (("stop", not tracks), ("track", tracks)):
                form = re.search(rf'<form class="action"[^>]*action="{T1}/{path}"[^>]*>', slots)
                assert form is not None
                assert form[0].rstrip(">").endswith(" hidden") is hidden, case


@pytest.mark.parametrize("path", ["stop", "track", "park", "reset-fault", "stow", "resume"])
async def test_the_answer_of_a_button_leaves_no_sentence_behind(
    path: str, client: httpx.AsyncClient, machine: FakeMachine, staged: StagedTracker
) -> None:
    answer = await client.post(f"{T1}/{path}", data={"position": "wind"}, headers={"HX-Request": "true"})
    assert (answer.status_code, answer.text) == (200, "")
    assert len(machine.orders) == 1


def control(name: str, other: str) -> dict[str, ControlState]:
    """Return every way in which somebody can stand to control, by its word."""
    mine, of_another = ControlState(1, name, "session", 1), ControlState(1, other, "session", 1)

    def wish(by: str, *, takes: bool = False, can_be_refused: bool = True) -> ControlRequest:
        return ControlRequest(by, "session", takes, "Storm.", AT, can_be_refused=can_be_refused)

    return {
        "free": ControlState(0),
        "mine": mine,
        "wished": replace(mine, request=wish(other)),
        "forced": replace(mine, request=wish(other, takes=True, can_be_refused=False)),
        "held": replace(of_another, rank=0),
        "above": replace(of_another, rank=3),
        "asked": replace(of_another, request=wish(name)),
        "waiting": replace(of_another, request=wish(name, takes=True)),
    }


@pytest.mark.parametrize("role", list(Role))
async def test_every_page_tells_each_role_under_each_control_why_a_button_is_off(
    role: Role, office: Office
) -> None:
    tracker = StagedTracker(commissioned("T1", "North field", tracking=False), Pair(180.0, 45.0))
    office.machine.trackers["T1"] = tracker
    tracker.refused = (OPERATOR,)
    off = 0
    others = cycle([*PAGES[1:], *(T1 + path for path in OTHER_PAGES)])
    walk = product(control(f"{role}-1", "ada").items(), ("at standstill", "tracking", "not stowed"))
    async with office.browser(await office.session(role)) as browser:
        for (standing, held), name in walk:
            case = CASES[name]
            tracker.case = replace(case, fields=case.fields | {"control": held})
            office.machine.emit()
            for path in (T1, *islice(others, 3)):
                text = (await browser.get(path)).text
                where = (standing, name, path)
                check(text, case.word, seen(office.machine), live=path == T1)
                assert f'data-state="{standing}"' in text, where
                for form in FORM.findall(text):
                    off += bool(OFF.search(form))
                    assert not OFF.search(form) or WHY.search(form), (*where, form)
    assert off
