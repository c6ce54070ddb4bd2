"""The book of alarms: every state of ISA-18.2, delays, first-out, floods, and a random life of it."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from app.alarms import lifecycle as pages
from app.alarms.catalogue import CATALOGUE
from app.alarms.conditions import Condition
from app.alarms.lifecycle import Book, Change, Happened, UnknownAlarm
from app.alarms.view import Ranking, Shown
from app.tracker.values.alarm_words import MOST_SHOWN, AlarmState
from tests.amount import amount

NOON = datetime(2027, 6, 21, 9, 0, tzinfo=UTC)
SITE_OFFSET = timedelta(hours=2, seconds=7)
SHIFT = timedelta(minutes=30)


def of(code: str, tracker_id: str | None = "T1") -> Condition:
    return Condition(code, tracker_id, "North field", f"It is {code}.")


@dataclass
class Desk:
    """A book and its clock; the site's clock is ahead of the steady one."""

    now: datetime = NOON
    book: Book = field(default_factory=Book)
    changes: list[Change] = field(default_factory=list)
    maintenance: frozenset[str] = frozenset()
    settled: bool = True

    @property
    def at(self) -> datetime:
        return self.now + SITE_OFFSET

    def see(self, *present: Condition, for_s: float = 0.5) -> None:
        """Look twice a second for a while."""
        for _ in range(round(for_s / 0.5)):
            self.now += timedelta(seconds=0.5)
            self._turn(
                pages.step(
                    self.book, present, self.at, self.now,
                    maintenance=self.maintenance, settled=self.settled,
                )
            )  # fmt: skip

    def acknowledge(self, name: str, by: str = "ayse") -> None:
        self._turn(pages.acknowledge(self.book, name, by, self.at))

    def shelve(self, name: str, reason: str = "known", duration: timedelta = SHIFT) -> None:
        self._turn(pages.shelve(self.book, name, "ayse", reason, duration, self.now))

    def unshelve(self, name: str) -> None:
        self._turn(pages.unshelve(self.book, name, "ayse"))

    def state(self, name: str) -> AlarmState:
        alarm = self.book.alarms.get(name)
        return AlarmState.NORMAL if alarm is None else alarm.state

    def happened(self, name: str) -> list[Happened]:
        return [one.what for one in self.changes if one.alarm.alarm_id == name]

    def _turn(self, turned: tuple[Book, Iterable[Change]]) -> None:
        self.book = turned[0]
        self.changes.extend(turned[1])


@pytest.fixture
def desk() -> Desk:
    return Desk()


def test_an_alarm_is_raised_seen_and_over(desk: Desk) -> None:
    desk.see(of("drive_fault"))
    assert desk.state("drive_fault@T1") is AlarmState.UNACKNOWLEDGED
    assert desk.book.alarms["drive_fault@T1"].raised_at == desk.at
    desk.acknowledge("drive_fault@T1")
    assert desk.state("drive_fault@T1") is AlarmState.ACKNOWLEDGED
    desk.see(for_s=4)
    assert desk.state("drive_fault@T1") is AlarmState.NORMAL
    assert not desk.book.alarms
    assert desk.happened("drive_fault@T1") == [Happened.RAISED, Happened.ACKNOWLEDGED, Happened.RETURNED]


def test_one_that_returns_unseen_waits_to_be_acknowledged(desk: Desk) -> None:
    desk.see(of("drive_fault"))
    desk.see(for_s=4)
    assert desk.state("drive_fault@T1") is AlarmState.RETURNED
    desk.see(of("drive_fault"))
    assert desk.state("drive_fault@T1") is AlarmState.UNACKNOWLEDGED
    assert desk.book.alarms["drive_fault@T1"].occurrences == 2
    desk.see(for_s=4)
    desk.acknowledge("drive_fault@T1")
    assert desk.state("drive_fault@T1") is AlarmState.NORMAL


def test_it_lasts_for_its_delay_before_it_is_raised_and_before_it_returns(desk: Desk) -> None:
    desk.see(of("drive_lost"), for_s=3)
    assert desk.state("drive_lost@T1") is AlarmState.NORMAL
    desk.see(for_s=0.5)
    desk.see(of("drive_lost"), for_s=3)
    assert not desk.changes, "it chattered within its delay"
    desk.see(of("drive_lost"))
    assert desk.state("drive_lost@T1") is AlarmState.UNACKNOWLEDGED
    for _ in range(20):
        desk.see(for_s=2.5)
        desk.see(of("drive_lost"), for_s=0.5)
    assert desk.happened("drive_lost@T1") == [Happened.RAISED]


def test_a_shelved_alarm_comes_back_by_itself(desk: Desk) -> None:
    desk.see(of("disk_full", None), for_s=4)
    desk.shelve("disk_full", "Gu\u0308nes\u0327\u00a0K.", timedelta(minutes=1))
    shelf = desk.book.alarms["disk_full"].shelf
    assert shelf is not None
    assert shelf.reason == "Güneş K.", "a reason has one spelling"
    desk.see(of("disk_full", None), for_s=59)
    assert desk.state("disk_full") is AlarmState.SHELVED
    desk.see(of("disk_full", None), for_s=2)
    assert desk.state("disk_full") is AlarmState.UNACKNOWLEDGED
    assert desk.happened("disk_full")[-2:] == [Happened.UNSHELVED, Happened.RAISED]
    desk.shelve("disk_full", duration=timedelta(minutes=1))
    desk.see(for_s=61)
    assert desk.state("disk_full") is AlarmState.NORMAL, "its cause went meanwhile"


def test_one_taken_back_from_the_shelf_is_announced_anew(desk: Desk) -> None:
    desk.see(of("drive_fault"))
    desk.acknowledge("drive_fault@T1")
    desk.shelve("drive_fault@T1")
    desk.unshelve("drive_fault@T1")
    desk.see(of("drive_fault"))
    assert desk.state("drive_fault@T1") is AlarmState.UNACKNOWLEDGED


@pytest.mark.parametrize(
    ("code", "reason", "duration", "words"),
    [
        ("not_stowed", "known", SHIFT, "priority 1 cannot be shelved"),
        ("drive_fault", "  ", SHIFT, "Enter the reason"),
        ("drive_fault", "known\u202e", SHIFT, "U\\+202E"),
        ("drive_fault", "known", timedelta(hours=24, seconds=1), "1 minute to 24 hours"),
        ("drive_fault", "known", timedelta(seconds=59), "1 minute to 24 hours"),
    ],
)
def test_not_everything_is_shelved(
    desk: Desk, code: str, reason: str, duration: timedelta, words: str
) -> None:
    desk.see(of(code), for_s=4)
    with pytest.raises(ValueError, match=words):
        desk.shelve(f"{code}@T1", reason, duration)


def test_what_its_cause_explains_is_suppressed_and_announced_if_it_outlasts_it(desk: Desk) -> None:
    both = (of("drive_lost"), of("operator_needed"))
    desk.see(*both, for_s=5)
    assert desk.state("drive_lost@T1") is AlarmState.UNACKNOWLEDGED
    assert desk.state("operator_needed@T1") is AlarmState.SUPPRESSED
    assert desk.happened("operator_needed@T1") == []
    assert desk.book.alarms["operator_needed@T1"].suppressed_by == "drive_lost"
    desk.see(of("operator_needed"), for_s=4)
    assert desk.state("operator_needed@T1") is AlarmState.UNACKNOWLEDGED


def test_maintenance_takes_a_tracker_out_of_service_but_not_priority_1() -> None:
    desk = Desk(maintenance=frozenset({"T1"}))
    seen = (of("drive_fault"), of("not_stowed"), of("drive_fault", "T2"))
    desk.see(*seen, for_s=4)
    assert desk.state("drive_fault@T1") is AlarmState.OUT_OF_SERVICE
    assert desk.state("not_stowed@T1") is AlarmState.UNACKNOWLEDGED
    assert desk.state("drive_fault@T2") is AlarmState.UNACKNOWLEDGED
    desk.maintenance = frozenset()
    desk.see(*seen)
    assert desk.state("drive_fault@T1") is AlarmState.UNACKNOWLEDGED


def test_the_first_of_a_group_is_marked(desk: Desk) -> None:
    desk.see(of("encoder_jump"))
    desk.see(of("encoder_jump"), of("following_error"), of("following_error", "T2"), of("drive_fault"))
    first = {name for name, alarm in desk.book.alarms.items() if alarm.first_out}
    assert first == {"encoder_jump@T1", "following_error@T2", "drive_fault@T1"}


def test_an_alarm_says_what_to_do_now_as_its_condition_has_it_else_in_general(desk: Desk) -> None:
    for hint in ("Clear the area, then press Stow.", "Jog the axis away from the switch.", ""):
        desk.see(replace(of("not_stowed"), hint=hint), for_s=5.0)
        alarms, *_ = shown(desk)
        assert [one.do for one in alarms] == [hint or CATALOGUE["not_stowed"].do]


def shown(desk: Desk) -> Shown:
    ranking = Ranking()
    for place in {one.tracker_id for one in desk.book.alarms.values()}:
        mine = [one for one in desk.book.alarms.values() if one.tracker_id == place]
        ranking.renew(place, mine, desk.at, desk.now, flood=desk.book.flood)
    return ranking.shown(flood=desk.book.flood)


def marked(desk: Desk) -> set[str]:
    return {one.alarm_id for one in shown(desk)[0] if one.first_out}


def test_an_alarm_is_shown_as_the_first_only_where_others_followed(desk: Desk) -> None:
    desk.see(of("encoder_jump"), of("drive_fault", "T2"))
    assert marked(desk) == set(), "of one alarm there is no first"
    desk.see(of("encoder_jump"), of("following_error"), of("drive_fault", "T2"))
    assert marked(desk) == {"encoder_jump@T1"}


def test_what_keeps_a_panel_from_its_stow_is_first_and_not_stowed_follows_it(desk: Desk) -> None:
    stuck, unstowed = of("limit_switch"), of("not_stowed")
    desk.see(stuck)
    desk.see(stuck, unstowed, of("not_stowed", "T2"), for_s=4)
    assert desk.state("not_stowed@T1") is desk.state("not_stowed@T2") is AlarmState.UNACKNOWLEDGED
    assert marked(desk) == {"limit_switch@T1"}


def test_a_flood_is_one_more_alarm_and_puts_the_lesser_behind(desk: Desk) -> None:
    many = [of("drive_restarted", f"T{number}") for number in range(11)]
    urgent = [of("not_stowed", f"T{number}") for number in range(60)]
    desk.see(*many[:10])
    assert not desk.book.flood
    desk.see(*many)
    desk.see(*many)
    assert desk.state("alarm_flood") is AlarmState.UNACKNOWLEDGED
    desk.see(*many, *urgent, for_s=4)
    listed, counts = shown(desk)
    assert {one.priority for one in listed} == {1}
    assert len(listed) == MOST_SHOWN
    assert counts.standing == (60, 1, 11, 0)
    assert counts.more == 60 + 1 + 11 - MOST_SHOWN
    desk.see(*many, for_s=5)
    for number in range(60):
        desk.acknowledge(f"not_stowed@T{number}")
    desk.see(*many)
    listed, _ = shown(desk)
    assert [one.collapsed for one in listed] == [False, *[True] * 11]


def test_a_flood_is_over_when_it_has_been_quiet(desk: Desk) -> None:
    many = [of("drive_restarted", f"T{number}") for number in range(11)]
    desk.see(*many, for_s=2)
    assert desk.book.flood
    desk.see(*many, for_s=600)
    assert not desk.book.flood
    desk.see(*many)
    assert desk.state("alarm_flood") is AlarmState.RETURNED


def test_a_restart_keeps_what_stood_and_forgets_nothing_too_early(desk: Desk) -> None:
    desk.see(of("drive_fault"), of("disk_full", None), for_s=4)
    desk.acknowledge("drive_fault@T1")
    again = Desk(now=desk.now + timedelta(minutes=5), book=pages.restored(desk.book.alarms.values()))
    again.settled = False
    again.see(for_s=9)
    assert again.state("drive_fault@T1") is AlarmState.ACKNOWLEDGED
    again.settled = True
    again.see(of("drive_fault"), for_s=60)
    assert again.state("drive_fault@T1") is AlarmState.ACKNOWLEDGED
    assert again.state("disk_full") is AlarmState.RETURNED
    assert again.happened("drive_fault@T1") == []


def test_only_what_lasts_is_kept(desk: Desk) -> None:
    desk.see(of("drive_fault"))
    before = desk.book
    desk.see(replace(of("drive_fault"), message="Now it is 7."))
    assert pages.to_keep(before, desk.book, desk.at) == ()
    desk.acknowledge("drive_fault@T1")
    seen = desk.book
    ((alarm, ended_at),) = pages.to_keep(before, seen, desk.at)
    assert (alarm.acknowledged_by, ended_at) == ("ayse", None)
    desk.see(for_s=4)
    ((alarm, ended_at),) = pages.to_keep(seen, desk.book, desk.at)
    assert (alarm.active, alarm.returned_at, ended_at) == (False, desk.at, desk.at)


CODES = ("not_stowed", "drive_lost", "operator_needed", "drive_fault", "drive_restarted", "light_sensor_bad")
CONDITIONS = tuple(of(code, tracker) for code in CODES for tracker in ("T1", "T2", "T3"))


class LifeOfABook(RuleBasedStateMachine):
    """Conditions come and go, operators do what they like, time passes."""

    def __init__(self) -> None:
        super().__init__()
        self.desk = Desk()
        self.present: frozenset[Condition] = frozenset()

    @rule(present=st.frozensets(st.sampled_from(CONDITIONS)), seconds=st.sampled_from((0.5, 2.0, 4.0)))
    def live(self, present: frozenset[Condition], seconds: float) -> None:
        self.present = present
        self.desk.see(*present, for_s=seconds)

    @rule(condition=st.sampled_from(CONDITIONS), minutes=st.integers(0, 1500))
    def shelve(self, condition: Condition, minutes: int) -> None:
        try:
            self.desk.shelve(condition.alarm_id, duration=timedelta(minutes=minutes))
        except (UnknownAlarm, ValueError):
            assert self.desk.happened(condition.alarm_id)[-1:] != [Happened.SHELVED] or minutes != 10

    @rule(condition=st.sampled_from(CONDITIONS), unshelves=st.booleans())
    def act(self, condition: Condition, unshelves: bool) -> None:
        stood = self.desk.state(condition.alarm_id) is not AlarmState.NORMAL
        try:
            (self.desk.unshelve if unshelves else self.desk.acknowledge)(condition.alarm_id)
        except UnknownAlarm:
            assert not stood
        else:
            assert stood

    @rule(trackers=st.frozensets(st.sampled_from(("T1", "T2", "T3"))))
    def maintain(self, trackers: frozenset[str]) -> None:
        self.desk.maintenance = trackers
        self.desk.see(*self.present)

    @rule()
    def restart(self) -> None:
        standing = [one for one in self.desk.book.alarms.values() if one.stands]
        before = {one.alarm_id: one.state for one in standing}
        self.desk.book = pages.restored(standing)
        assert {name: self.desk.state(name) for name in before} == before

    @invariant()
    def priority_1_is_never_hidden(self) -> None:
        ranked, counts = shown(self.desk)
        active = [one for one in self.desk.book.alarms.values() if one.active and one.entry.priority == 1]
        listed = {one.alarm_id: one for one in ranked}
        for alarm in active:
            assert listed[alarm.alarm_id].state in (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED)
            assert not listed[alarm.alarm_id].collapsed
        assert sum(counts.standing) + counts.shelved + counts.silenced == len(ranked) + counts.more

    @invariant()
    def nobody_acknowledges_but_people_and_nothing_is_shelved_for_ever(self) -> None:
        for alarm in self.desk.book.alarms.values():
            if alarm.acknowledged_at is not None:
                assert Happened.ACKNOWLEDGED in self.desk.happened(alarm.alarm_id)
            if alarm.shelf is not None:
                assert alarm.shelf.until - self.desk.now <= pages.LONGEST_SHELF
            if alarm.state in (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED):
                assert alarm.active

    @invariant()
    def what_was_raised_has_stood(self) -> None:
        for name in {one.alarm.alarm_id for one in self.desk.changes}:
            assert self.desk.happened(name)[0] is Happened.RAISED


LifeOfABook.TestCase.settings = settings(max_examples=amount(10, 40), stateful_step_count=12, deadline=None)
TestLifeOfABook = LifeOfABook.TestCase
