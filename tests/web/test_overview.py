"""The overview: the most urgent first, counts that add up and filter, and the one in danger above all."""

import re
from dataclasses import replace
from html import unescape

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.access.roles import Role
from app.alarms.urgency import by_urgency, state_of
from app.tracker.state.snapshot import ActivityName, Pair, Snapshot
from app.tracker.values.operator_message import INFORMATION, OperatorMessage, StateWord
from app.web.features.control.overview import Layout
from app.web.services.narrowed import narrowed_site
from app.web.shell.glances import IN_DANGER, LOOKS, counts_of
from tests.browser.storm import IN_DANGER as NOT_STOWED
from tests.browser.storm import SIXTY, STOWING, endanger, sixty_in_a_storm
from tests.every_state import AT, CASES, StagedTracker, short_walk
from tests.fake_data import commissioned
from tests.fakes import FakeMachine
from tests.web.office import Office

ITEM = re.compile(r'data-item="([^"]+)"[^>]*?( hidden)?>')
COUNT = re.compile(
    r'data-state="(\w*)" data-priority="(\d)" aria-pressed="(\w+)"( hidden)?>.*?<b>(\d+)</b>', re.S
)
ALL = re.compile(r'class="count count-all"[^>]*aria-pressed="(\w+)"><b>(\d+)</b>')


def shown(page: str) -> list[str]:
    return [name for name, hidden in ITEM.findall(page) if not hidden]


def counted(page: str) -> dict[str, int]:
    return {state: int(number) for state, _, _, hidden, number in COUNT.findall(page) if not hidden}


def staged(name: str, case: str) -> StagedTracker:
    tracker = StagedTracker(commissioned(name, f"Row {name[1:]}", tracking=False), Pair(180.0, 45.0))
    tracker.case = CASES[case]
    return tracker


def stage(machine: FakeMachine, *cases: str) -> None:
    machine.trackers = {f"T{number}": staged(f"T{number}", case) for number, case in enumerate(cases, 1)}
    machine.emit()


@pytest.mark.parametrize("layout", list(Layout))
async def test_in_every_layout_the_most_urgent_come_first_and_equals_as_the_site_has_them(
    layout: Layout, client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    sixty_in_a_storm(machine)
    order = shown((await client.get("/", params={"layout": layout})).text)
    calm = [name for name in machine.trackers if name not in (*NOT_STOWED, *STOWING)]
    assert order == [*NOT_STOWED, *STOWING, *calm]


async def test_the_storm_is_counted_in_three_numbers_that_add_up(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    sixty_in_a_storm(machine)
    page = (await client.get("/")).text
    assert list(counted(page).items()) == [("not_stowed", 3), ("stowing", 2), ("stowed", 55)]
    assert ALL.findall(page) == [("true", "60")]
    assert COUNT.findall(page)[0][1] == "1", "the count of those in danger has the color of their alarm"
    assert [found[1] for found in COUNT.findall(page) if not found[3]] == ["1", "0", "0"]


async def test_every_state_is_counted_once_and_can_be_shown_alone(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    stage(machine, *short_walk())
    counts = counted((await client.get("/")).text)
    assert set(counts) == set(StateWord), "some state is never reached or never counted"
    assert sum(counts.values()) == len(machine.trackers)
    for state, number in counts.items():
        alone = (await client.get("/", params={"state": state})).text
        wanted = [one.tracker_id for one in by_urgency(machine.latest().trackers) if one.state == state]  # type: ignore[union-attr]
        assert shown(alone) == wanted
        assert len(wanted) == number
        assert re.search(rf'value="" data-state="{state}" data-priority="\d" aria-pressed="true"', alone)
        assert ALL.findall(alone)[0][0] == "false"
        assert counted(alone) == counts, "what is shown alone does not change what is counted"


@given(st.lists(st.sampled_from(StateWord), max_size=40), st.randoms(use_true_random=False))
def test_counts_are_disjoint_and_the_order_is_by_priority_then_state(
    states: list[StateWord], chance: object
) -> None:
    trackers = [
        at(f"T{number}", state, chance.choice((1, 2, 3, 4, INFORMATION, None)))
        for number, state in enumerate(states)
    ]  # type: ignore[attr-defined]
    counts = counts_of(trackers)
    assert [one.state for one in counts] == list(StateWord)
    assert sum(one.number for one in counts) == len(trackers)
    assert all(one.priority == 0 for one in counts if one.state not in IN_DANGER)
    keys = [(first(one), rank(one.state)) for one in by_urgency(trackers)]
    assert keys == sorted(keys)
    calm = [
        one.tracker_id for one in by_urgency(trackers) if (first(one), rank(one.state)) == (INFORMATION, 4)
    ]
    assert calm == [one.tracker_id for one in trackers if one.tracker_id in calm], "as the site has them"


def rank(state: StateWord) -> int:
    first_states = (
        StateWord.NOT_STOWED, StateWord.FAULT, StateWord.NO_CONNECTION, StateWord.STOWING,
    )  # fmt: skip
    return first_states.index(state) if state in first_states else len(first_states)


def first(one: Snapshot) -> int:
    return one.messages[0].priority if one.messages else INFORMATION


def at(name: str, state: StateWord, priority: int | None) -> Snapshot:
    calm = staged(name, "at standstill").snapshot(AT, 1)
    told = () if priority is None else (OperatorMessage("x", priority, "Something."),)
    return replace(calm, state=state, messages=told)


async def test_a_state_that_nobody_is_in_says_so_and_can_be_left(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    sixty_in_a_storm(machine)
    page = (await client.get("/?state=jogging")).text
    assert shown(page) == []
    assert re.search(r'id="none-alike">No tracker is in this state now.<', page)
    assert counted(page)["jogging"] == 0
    assert shown((await client.get("/?state=")).text) == shown((await client.get("/")).text)
    assert (await client.get("/?state=flying")).status_code == 422


def urgent_of(page: str) -> str:
    return unescape(page.split('id="site-urgent"')[1].split("</section>")[0])


async def test_the_one_in_danger_is_told_above_all_and_is_stowed_from_there(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    sixty_in_a_storm(machine)
    urgent = urgent_of((await client.get("/")).text)
    assert 'data-tracker="T31" data-priority="1">' in urgent
    assert "<h2>T31 Row 31: Not stowed</h2>" in urgent
    assert "Row 31 is NOT STOWED" in urgent
    assert "press Stow." in urgent
    assert 'href="/?state=not_stowed" aria-label="2 more: Not stowed">2 more</a>' in urgent
    assert '<a class="key" id="urgent-open" href="/trackers/T31">Open T31</a>' in urgent
    form = re.search(
        r'<form class="action" method="post" action="/trackers/T31/stow"([^>]*)>(.*?)</form>', urgent, re.S
    )
    assert form is not None
    assert "hidden" not in form[1]
    assert '<input type="hidden" name="position" value="wind">' in form[2]
    assert "<span>Stow T31</span>" in form[2]
    answer = await client.post("/trackers/T31/stow", data={"position": "wind"})
    assert answer.status_code == 303
    assert machine.orders[-1].tracker_id == "T31"
    assert machine.orders[-1].command.kind == "stow"


@pytest.mark.parametrize(
    ("case", "tracker_id", "stows"),
    [("not stowed", "T2", True), ("fault", "T2", False), ("silent drive while it holds", "T2", False)],
)
async def test_only_what_cannot_wait_is_told_above_all_and_only_one_not_stowed_is_stowed_there(
    case: str, tracker_id: str, stows: bool, client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    stage(machine, "tracking", case)
    urgent = urgent_of((await client.get("/")).text)
    assert f'data-tracker="{tracker_id}"' in urgent
    assert (' data-when="state=not_stowed">' in urgent) is stows
    assert 'id="urgent-more" href' in urgent
    assert re.search(r'id="urgent-more" href="[^"]*" hidden', urgent), "there is no other like it"


@pytest.mark.parametrize("case", ["at standstill", "waiting", "alarm link_poor"])
async def test_nothing_is_told_above_all_while_everything_can_wait(
    case: str, client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    stage(machine, case, case)
    assert 'data-tracker="" data-priority="" hidden>' in urgent_of((await client.get("/")).text)


async def test_whoever_may_not_stow_sees_who_may(office: Office) -> None:
    office.machine.trackers["T1"].activity = ActivityName.HOLDING
    endanger(office.machine, "T1")
    office.machine.emit()
    async with office.browser(await office.session(Role.VIEWER)) as viewer:
        urgent = urgent_of((await viewer.get("/")).text)
    assert '<fieldset class="denied" disabled>' in urgent
    assert "Only for" in urgent
    async with office.browser(await office.session(Role.OPERATOR)) as operator:
        assert "denied" not in urgent_of((await operator.get("/")).text)


async def test_tiles_rows_and_cards_show_state_and_head_and_never_a_number_of_alarms(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    stage(machine, "silent drive while it holds", "fault", "jogging", "tracking")
    tiles = (await client.get("/?layout=tiles")).text
    looks = re.findall(r'data-tile="(\w+)" data-look="([\w-]*)" data-priority="(\d)"', tiles)
    assert {name: (look, priority) for name, look, priority in looks} == {
        "T1": ("unknown", "2"), "T2": ("fault", "2"), "T3": ("manual", "0"), "T4": ("", "0"),
    }  # fmt: skip
    assert "No connection Drive does not answer</span>" in tiles
    for layout in (Layout.ROWS, Layout.CARDS):
        page = (await client.get("/", params={"layout": layout})).text
        silent = page.split('data-item="T1"')[1].split("</li>")[0]
        assert 'data-live="state" data-form="words">No connection<' in silent
        assert "<span>Drive does not answer</span>" in silent
        assert "Holding" not in re.sub(r"<p class=\"card-text\"[^>]* hidden>.*?</p>", "", silent, flags=re.S)


def test_every_look_is_of_a_state_that_is_reached() -> None:
    reached = {state_of(staged("T1", case).snapshot(AT, 1)) for case in CASES}
    assert set(LOOKS) <= reached == set(StateWord)


async def test_an_alarm_leads_to_its_tracker_in_one_tap(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    sixty_in_a_storm(machine)
    page = (await client.get("/alarms")).text
    outside = re.sub(r"<details.*?</details>", "", page, flags=re.S)
    assert re.findall(r'<a class="key alarm-open" href="/trackers/(\w+)">', outside) == list(NOT_STOWED)
    assert len(machine.trackers) == SIXTY


async def test_the_only_tracker_is_shown_whatever_the_address_asks_for(
    client: httpx.AsyncClient, machine: FakeMachine
) -> None:
    stage(machine, "not stowed")
    assert shown((await client.get("/?state=stowed")).text) == ["T1"]


def test_who_sees_one_tracker_of_many_in_trouble_is_told_of_that_one(machine: FakeMachine) -> None:
    stage(machine, *["not stowed"] * 60)
    site = machine.latest()
    assert site is not None
    assert [message.tracker_id for message in narrowed_site(site, frozenset({"T60"})).messages] == ["T60"]
