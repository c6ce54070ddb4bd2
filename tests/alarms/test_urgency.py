"""One place decides what is most urgent: the state in a word, the messages in their order, the site."""

from dataclasses import replace
from datetime import timedelta

import pytest

from app.alarms.alarm import Alarm, Shelf
from app.alarms.catalogue import CATALOGUE
from app.alarms.urgency import (
    by_urgency,
    headline,
    messages_of,
    newest,
    site_messages,
    state_of,
    with_messages,
)
from app.base.message import N_
from app.tracker.protections.words import ServiceMode, ServiceState
from app.tracker.state.snapshot import ActivityName, Event, EventKind, Pair, Snapshot
from app.tracker.values.actors import CONTROLLER
from app.tracker.values.operator_message import INFORMATION, StateWord
from app.tracker.values.reason import Reason
from tests.every_state import AT, CASES, FAULT, NOT_STOWED, OPERATOR, SILENT, SUN_DOWN, Case, StagedTracker
from tests.fake_alarms import alarm
from tests.fake_data import commissioned


def tracker(case: Case | None = None, tracker_id: str = "T1", **fields: object) -> Snapshot:
    staged = StagedTracker(commissioned(tracker_id, "North field", tracking=False), Pair(180.0, 45.0))
    staged.case = case or CASES["at standstill"]
    return replace(staged.snapshot(AT, 1), **fields)  # type: ignore[arg-type]


def event(kind: EventKind, actor: str = "ada", at_s: float = 0.0) -> Event:
    return Event(AT + timedelta(seconds=at_s), kind, "T1", N_("Something happened."), actor)


def codes(one: Snapshot, last: Event | None = None) -> list[str]:
    return [message.code for message in messages_of(one, {}, last)]


@pytest.mark.parametrize("name", list(CASES))
def test_every_state_has_its_word_and_its_first_message(name: str) -> None:
    case = CASES[name]
    told = with_messages(tracker(case), {}, None)
    assert told.state is case.word
    assert next((message.code for message in told.messages), "") == case.first


def test_every_word_is_the_state_of_some_tracker() -> None:
    assert {case.word for case in CASES.values()} == set(StateWord)


def test_a_motion_that_begins_is_first_then_alarms_by_priority_then_all_else() -> None:
    found = codes(tracker(CASES["not stowed, faulted, silent, local"]))
    assert found == [
        "motion_ahead", "not_stowed", "following_error", "drive_lost", "operator_needed", "local",
    ]  # fmt: skip


def test_a_stop_is_told_with_who_pressed_it_before_what_is_waited_for() -> None:
    waiting = tracker(CASES["waiting"])
    first = messages_of(waiting, {}, event(EventKind.STOPPED, "vic"))[0]
    assert (first.code, str(first.title), first.since) == ("stopped", "Stopped by vic", AT)
    assert codes(waiting, event(EventKind.TRACKING_STARTED)) == ["sun_down", "tracking_started"]


def test_a_stop_stands_before_the_alarms_it_found_there_behind_danger_and_what_came_later() -> None:
    before, after = (AT - timedelta(seconds=90), AT + timedelta(seconds=1))
    raised = {
        code: Alarm(code, "T1", "A", FAULT.message, active=True, told=True, raised_at=at)
        for code, at in (("home_lost", before), ("limit_switch", after))
    }
    danger = tracker(CASES["not stowed"])
    for last, expected in (
        (event(EventKind.STOPPED), ["not_stowed", "limit_switch", "stopped", "home_lost"]),
        (event(EventKind.STOPPED, CONTROLLER), ["not_stowed", "home_lost", "limit_switch", "stopped"]),
        (event(EventKind.TRACKING_STARTED), ["not_stowed", "home_lost", "limit_switch", "tracking_started"]),
    ):
        told = messages_of(danger, raised, last)
        assert [message.code for message in told][:4] == expected
    stopped = with_messages(tracker(), {"home_lost": raised["home_lost"]}, event(EventKind.STOPPED))
    assert [message.code for message in stopped.messages] == ["stopped", "home_lost"]
    assert headline(stopped) == stopped.messages[1], "the overview names the alarm"


def test_what_the_controller_stopped_by_itself_is_told_as_that() -> None:
    told = messages_of(tracker(), {}, event(EventKind.STOPPED, CONTROLLER))[0]
    assert (str(told.title), told.by) == ("Something happened.", "")
    assert messages_of(tracker(), {}, event(EventKind.HOME_POSITION_SET))[0].by == "ada"


def test_the_last_thing_that_happened_ends_with_the_next() -> None:
    stop, later = event(EventKind.STOPPED), event(EventKind.JOG_STARTED, at_s=3.0)
    assert newest(event(EventKind.TRACKING_STARTED), stop) is stop
    assert newest(stop, later) is later
    assert newest(stop, event(EventKind.ALARM_RAISED, at_s=1.0)) is stop, "an alarm is told by itself"


def test_what_a_stop_ended_does_not_hide_who_stopped_whatever_is_told_first() -> None:
    stop, ended = event(EventKind.STOPPED), event(EventKind.TRACKING_ENDED)
    assert newest(newest(None, stop), ended) is stop
    assert newest(newest(None, ended), stop) is stop


def test_what_two_parts_of_a_snapshot_say_is_told_once() -> None:
    noted = replace(SUN_DOWN, hint=N_("Another hint."))
    told = messages_of(tracker(CASES["waiting"], notices=(noted, noted)), {}, None)
    assert [(one.code, one.hint) for one in told] == [("sun_down", SUN_DOWN.hint)]


def test_a_shelved_alarm_is_not_told_and_one_that_calls_says_so() -> None:
    faulted = tracker(CASES["fault"])
    raised = Alarm("following_error", "T1", "A", FAULT.message, active=True, told=True, raised_at=AT)
    told = messages_of(faulted, {raised.alarm_id: raised}, None)[0]
    assert (told.calls, told.since, told.alarm_id) == (True, AT, "following_error@T1")
    seen = replace(raised, acknowledged_at=AT)
    assert not messages_of(faulted, {raised.alarm_id: seen}, None)[0].calls


def test_the_state_of_a_tracker_is_told_though_its_alarm_is_shelved_and_other_alarms_are_not() -> None:
    shelf = Shelf(AT, "ada", "Known.")
    for name, code in (
        ("not stowed", "not_stowed"),
        ("fault", "following_error"),
        ("unknown fault", "fault"),
    ):
        shelved = Alarm(code, "T1", "A", FAULT.message, active=True, told=True, raised_at=AT, shelf=shelf)
        told = messages_of(tracker(CASES[name]), {shelved.alarm_id: shelved}, None)
        assert [(one.code, one.calls) for one in told] == [(code, False)]
    poor = Alarm("link_poor", "T1", "A", FAULT.message, active=True, told=True, raised_at=AT, shelf=shelf)
    assert messages_of(tracker(), {poor.alarm_id: poor}, None) == ()


def test_service_mode_says_whether_the_area_is_clear() -> None:
    for clear_s, words in ((60.0, "is confirmed clear."), (0.0, "Nothing moves until")):
        told = messages_of(tracker(service=ServiceState(ServiceMode("ada", "ada", AT), clear_s)), {}, None)
        assert [one.code for one in told] == ["service"]
        assert words in f"{told[0].message} {told[0].hint}"
        assert ("Nothing moves" in f"{told[0].message}{told[0].hint}") is (clear_s == 0.0)


def test_a_tracker_on_local_is_told_at_its_site_whatever_else_it_tells_first() -> None:
    local = with_messages(tracker(local=True, warning=CASES["motion announced"].fields["warning"]), {}, None)
    assert local.messages[0].code == "motion_ahead"
    assert [one.code for one in site_messages([local], ())] == ["local"]


def test_every_activity_has_a_word() -> None:
    for activity in ActivityName:
        assert state_of(tracker(activity=activity)) in StateWord


def test_an_alarm_ends_with_its_condition_though_it_lasts_a_little_longer_in_the_book() -> None:
    poor = Alarm("link_poor", "T1", "North field", N_("5 % failed."), active=True, told=True, raised_at=AT)
    assert [one.code for one in messages_of(tracker(), {poor.alarm_id: poor}, None)] == ["link_poor"]
    assert messages_of(tracker(), {poor.alarm_id: replace(poor, gone_since=AT)}, None) == ()


def test_a_site_names_the_trackers_in_trouble_and_its_own_alarms_the_most_urgent_first() -> None:
    told = [
        with_messages(tracker(CASES[name], f"T{number}"), {}, None)
        for number, name in enumerate(("tracking", "fault", "waiting", "not stowed"), 1)
    ]
    found = site_messages(told, (alarm("disk_low", AT, None), alarm("drive_lost", AT, "T2")))
    assert [(one.code, one.tracker_id) for one in found] == [
        ("not_stowed", "T4"), ("following_error", "T2"), ("disk_low", None),
    ]  # fmt: skip
    assert [one.tracker_id for one in by_urgency(told)] == ["T4", "T2", "T1", "T3"]


def test_sixty_trackers_in_a_storm_fit_into_one_list() -> None:
    many = [with_messages(tracker(CASES["not stowed"], f"T{number}"), {}, None) for number in range(60)]
    assert len(site_messages(many, ())) == 50


def test_a_tracker_is_told_in_the_same_words_by_every_reason_that_lasts() -> None:
    noted = tracker(notices=(Reason("profile_unverified", N_("Not verified."), N_("Test it.")), OPERATOR))
    told = messages_of(noted, {}, None)
    assert [(one.code, one.priority) for one in told] == [
        ("operator_needed", CATALOGUE["operator_needed"].priority), ("profile_unverified", INFORMATION),
    ]  # fmt: skip
    silent = messages_of(tracker(unreachable=SILENT, not_stowed=NOT_STOWED), {}, None)
    assert [one.priority for one in silent] == [1, 2]
    assert state_of(tracker(unreachable=SILENT)) is StateWord.NO_CONNECTION
