"""Control authority as rules: whatever people and programs do, one has control and old orders are fenced."""

from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from app.site.state import authority as rules
from app.site.state.authority import Authority, Due, Verdict, Wish
from app.site.state.controls import Controls
from app.tracker.commands.commands import CommandRejected
from app.tracker.commands.control import ControlHeld, ControlLost, ControlState, Holder, refusal
from app.tracker.values.reason import Reason
from tests.amount import amount
from tests.fault_result import FaultResult

NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
OPERATOR, OTHER = Holder("ada", "session", 1), Holder("bo", "session", 1)
ENGINEER, PROGRAM = Holder("cy", "session", 2), Holder("pump (token)", "token", 2)
EVERYONE = (OPERATOR, OTHER, ENGINEER, PROGRAM)


def at(seconds: float) -> datetime:
    return NOON + timedelta(seconds=seconds)


def held_by(who: Holder) -> Authority:
    return rules.take(Authority(4), who, NOON)


def wish(who: Holder, *, takes: bool = True, seconds: float = 10) -> Wish:
    return Wish(who, takes, "rain", at(seconds))


@pytest.mark.fault(55)
def test_the_first_order_takes_control_and_others_are_told_who_has_it() -> None:
    free = Authority(4)
    assert rules.judge(free, OPERATOR, 4, NOON, "T1") is Verdict.TAKE
    taken = rules.take(free, OPERATOR, NOON, by_order=True)
    assert rules.judge(taken, OPERATOR, 4, NOON, "T1") is Verdict.GO, "given in the same moment"
    assert rules.judge(taken, OPERATOR, 5, NOON, "T1") is Verdict.GO
    with pytest.raises(ControlHeld, match="ada has control of T1"):
        rules.judge(taken, OTHER, 5, NOON, "T1")


@pytest.mark.fault(60)
def test_an_order_of_an_older_epoch_is_lost_even_for_who_has_control_again(fault: FaultResult) -> None:
    first = held_by(OPERATOR)
    again = rules.take(rules.take(first, OTHER, NOON), OPERATOR, NOON)
    for epoch in (4, first.epoch, first.epoch + 1):
        with pytest.raises(ControlLost, match="before control of T1 changed") as refused:
            rules.judge(again, OPERATOR, epoch, NOON, "T1")
        fault.shows(str(refused.value))
    assert rules.judge(again, OPERATOR, again.epoch, NOON, "T1") is Verdict.GO
    fault.prevented("the second order is refused, or answered as the first was")
    fault.recovers("with a new order")


def test_an_order_after_letting_go_does_not_take_control_again() -> None:
    let_go = rules.release(held_by(OPERATOR))
    with pytest.raises(ControlLost):
        rules.judge(let_go, OPERATOR, 5, NOON, "T1")
    assert rules.judge(let_go, OPERATOR, let_go.epoch, NOON, "T1") is Verdict.TAKE


def test_control_ends_when_nothing_is_heard_for_fifteen_seconds() -> None:
    held = rules.renew(held_by(OPERATOR), OPERATOR, at(5))
    assert rules.due(held, at(19.9)) is None
    assert rules.due(held, at(20)) is Due.EXPIRED
    assert rules.judge(held, OTHER, None, at(20), "T1") is Verdict.TAKE
    with pytest.raises(ControlLost):
        rules.judge(held, OPERATOR, held.epoch, at(20), "T1")


def test_a_person_takes_from_a_program_at_once_and_never_the_other_way_round() -> None:
    assert rules.passes_at_once(held_by(PROGRAM), OPERATOR)
    assert not rules.passes_at_once(held_by(OPERATOR), PROGRAM)
    with pytest.raises(ControlHeld, match="higher role"):
        rules.want(held_by(OPERATOR), wish(PROGRAM), "T1")


@pytest.mark.parametrize(
    ("holder", "taker", "silent_s", "refusable"),
    [(OPERATOR, OTHER, 0, True), (OPERATOR, ENGINEER, 0, False), (OPERATOR, OTHER, 6, False)],
)
def test_who_is_silent_or_lower_cannot_refuse(
    *, holder: Holder, taker: Holder, silent_s: float, refusable: bool
) -> None:
    wanted = rules.want(held_by(holder), wish(taker), "T1")
    if refusable:
        assert rules.refuse(wanted, at(silent_s)).wish is None
    else:
        with pytest.raises(CommandRejected, match="takes control because of a higher role"):
            rules.refuse(wanted, at(silent_s))
    assert rules.due(wanted, at(9.9)) is None
    assert rules.due(wanted, at(10)) is Due.PASSES


def test_a_lower_role_may_ask_and_can_always_be_refused() -> None:
    asked = rules.want(held_by(ENGINEER), wish(OPERATOR, takes=False, seconds=60), "T1")
    assert rules.refuse(asked, NOON).wish is None
    assert rules.due(rules.renew(asked, ENGINEER, at(55)), at(60)) is Due.LAPSED
    with pytest.raises(ControlHeld, match="ada has already requested control of T1"):
        rules.want(asked, wish(OTHER, takes=False), "T1")
    assert rules.want(asked, wish(Holder("di", "session", 2)), "T1").wish == wish(Holder("di", "session", 2))


def test_asking_may_become_taking_but_a_countdown_does_not_begin_anew() -> None:
    asked = rules.want(held_by(OPERATOR), wish(OTHER, takes=False, seconds=60), "T1")
    taking = rules.want(asked, wish(OTHER), "T1")
    assert taking.wish == wish(OTHER)
    assert rules.want(taking, wish(OTHER, seconds=14), "T1") is taking


class Contest(RuleBasedStateMachine):
    """People and programs order, ask, take, refuse, let go and fall silent, in any order."""

    def __init__(self) -> None:
        super().__init__()
        self.now, self.authority = NOON, Authority(1)
        self.given: list[tuple[Holder, int]] = []
        self.epochs = [1]
        self.owner: dict[int, Holder] = {}

    def become(self, authority: Authority) -> None:
        self.authority = authority
        if authority.epoch != self.epochs[-1]:
            self.epochs.append(authority.epoch)
        if authority.lease is not None:
            self.owner[authority.epoch] = authority.lease.holder

    def obey_time(self) -> None:
        due = rules.due(self.authority, self.now)
        wanted = self.authority.wish
        if due is Due.LAPSED:
            self.become(replace(self.authority, wish=None))
        elif due is not None and wanted is not None:
            self.become(rules.take(self.authority, wanted.by, self.now))
        elif due is Due.EXPIRED:
            self.become(rules.without_expired(self.authority, self.now))

    @rule(seconds=st.sampled_from([0.05, 1.0, 6.0, 10.0, 16.0]))
    def time_passes(self, seconds: float) -> None:
        self.now += timedelta(seconds=seconds)
        self.obey_time()

    @rule(who=st.sampled_from(EVERYONE))
    def order_now(self, who: Holder) -> None:
        self.given.append((who, self.authority.epoch))
        self.arrives(who, self.authority.epoch)

    @precondition(lambda self: self.given)
    @rule(data=st.data())
    def late_order_arrives(self, data: st.DataObject) -> None:
        self.arrives(*data.draw(st.sampled_from(self.given)))

    def arrives(self, who: Holder, epoch: int) -> None:
        before = self.authority
        try:
            verdict = rules.judge(before, who, epoch, self.now, "T1")
        except (ControlHeld, ControlLost):
            assert self.authority is before
            return
        if verdict is Verdict.TAKE:
            assert before.lease is None, "control that somebody has is never taken by an order"
            assert epoch == before.epoch, "an order given under an older control moves nothing"
            self.become(rules.take(before, who, self.now, by_order=True))
        else:
            assert before.is_held_by(who)
            assert epoch in (before.epoch, before.basis)
            assert not [one for one in self.owner if epoch < one < before.epoch], "nobody had it since"
            self.become(rules.renew(before, who, self.now))

    @rule(who=st.sampled_from(EVERYONE), takes=st.booleans())
    def wants(self, who: Holder, *, takes: bool) -> None:
        if self.authority.is_held_by(who):
            self.become(rules.renew(self.authority, who, self.now))
        elif rules.passes_at_once(self.authority, who):
            self.become(rules.take(self.authority, who, self.now))
        else:
            until = self.now + (rules.COUNTDOWN if takes else rules.ASK_LASTS)
            with suppress(ControlHeld):
                self.become(rules.want(self.authority, Wish(who, takes, "why", until), "T1"))

    @precondition(lambda self: self.authority.wish is not None)
    @rule()
    def holder_refuses(self) -> None:
        lease, wanted = self.authority.lease, self.authority.wish
        assert wanted is not None
        try:
            self.become(rules.refuse(self.authority, self.now))
        except CommandRejected:
            assert lease is None or not rules.can_be_refused(lease, wanted, self.now)

    @precondition(lambda self: self.authority.lease is not None)
    @rule()
    def holder_lets_go(self) -> None:
        self.become(rules.release(self.authority))

    @invariant()
    def epochs_only_grow(self) -> None:
        assert self.epochs == sorted(set(self.epochs))

    @invariant()
    def nobody_wants_what_they_have(self) -> None:
        wanted = self.authority.wish
        assert wanted is None or not self.authority.is_held_by(wanted.by)

    @invariant()
    def everyone_sees_what_is(self) -> None:
        state = rules.control_state(self.authority, self.now, self.now)
        assert state.epoch == self.authority.epoch
        assert (state.holder is None) == (self.authority.lease is None)


TestContest = Contest.TestCase
TestContest.settings = settings(max_examples=amount(25, 60), stateful_step_count=30, deadline=None)


def told_to(who: Holder, *, holder: Holder = OPERATOR) -> tuple[str, str]:
    reason = rules.held(holder, who, "T1")
    return reason.code, reason.hint


def test_who_is_refused_is_told_how_to_come_to_control() -> None:
    take_over = "Request control at the top of the page, or take control there with a reason."
    wait = "Request control at the top of the page and wait until it is handed over."
    post = "Request control (POST .../control), or wait until it is released."
    assert told_to(OTHER) == ("control_held", take_over), "of the same rank"
    assert told_to(ENGINEER) == ("control_held", take_over)
    assert told_to(OPERATOR, holder=ENGINEER) == ("control_held", wait)
    assert told_to(PROGRAM) == ("control_held", post)


def test_an_order_of_an_older_epoch_is_told_who_has_control_now_if_somebody_has() -> None:
    with pytest.raises(ControlLost) as free:
        rules.judge(Authority(4), OPERATOR, 3, NOON, "T1")
    assert free.value.reasons[0].message == (
        "This command was given before control of T1 changed, and is no longer carried out."
    )


def test_a_wish_outlives_the_lease_of_whom_it_was_for() -> None:
    asked = replace(held_by(OPERATOR), wish=wish(OTHER, seconds=60, takes=False))
    free = rules.without_expired(asked, at(15))
    assert (free.epoch, free.lease, free.wish) == (asked.epoch + 1, None, asked.wish)
    assert rules.without_expired(asked, at(14.9)) is asked


def test_letting_go_is_one_epoch() -> None:
    assert rules.release(held_by(OPERATOR)) == Authority(held_by(OPERATOR).epoch + 1)


@pytest.mark.parametrize("authority", [Authority(4), held_by(OPERATOR), Authority(4, wish=wish(OTHER))])
def test_where_nobody_wants_control_there_is_nothing_to_refuse(authority: Authority) -> None:
    with pytest.raises(CommandRejected) as rejected:
        rules.refuse(authority, NOON)
    assert [reason.code for reason in rejected.value.reasons] == ["no_wish"]


def test_what_everyone_sees_is_in_site_time() -> None:
    held = rules.renew(rules.take(Authority(4), ENGINEER, NOON), ENGINEER, at(3))
    wanted = replace(held, wish=wish(OTHER, seconds=12))
    hours = timedelta(hours=2)
    seen = rules.control_state(wanted, at(8), at(8) + hours)
    assert (seen.epoch, seen.holder, seen.via, seen.rank, seen.is_program) == (5, "cy", "session", 2, False)
    assert (seen.since, seen.expires) == (NOON + hours, at(18) + hours)
    assert seen.is_silent is False, "for 5 s everybody may be quiet"
    assert seen.request is not None
    assert (seen.request.by, seen.request.until) == ("bo", at(12) + hours)
    assert rules.control_state(wanted, at(8.001), at(8.001)).is_silent is True
    assert rules.control_state(Authority(4), NOON, NOON) == ControlState(4)


@pytest.mark.parametrize(
    ("codes", "kind"),
    [
        (("not_homed",), CommandRejected),
        (("not_homed", "control_held"), ControlHeld),
        (("control_lost",), ControlLost),
        (("control_held", "control_lost"), ControlLost),
    ],
)
def test_reasons_about_control_that_come_over_the_link_are_errors_about_control(
    codes: tuple[str, ...], kind: type[CommandRejected]
) -> None:
    reasons = tuple(Reason(code, "Why.") for code in codes)
    error = refusal(*reasons)
    assert type(error) is kind
    assert error.reasons == reasons


def test_a_tracker_begins_free_under_the_epoch_after_the_stored_one() -> None:
    controls = Controls()
    assert controls.of("T1", 7) == Authority(8)
    controls.put("T1", held_by(OPERATOR))
    assert controls.of("T1", 99) == held_by(OPERATOR)
    assert controls.of("T2", 0) == Authority(1)
    assert controls.lock("T1") is controls.lock("T1")
    assert controls.lock("T1") is not controls.lock("T2")
