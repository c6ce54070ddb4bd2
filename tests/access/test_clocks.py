"""Whatever clock wrote what is stored, and whatever clock reads it: no span lasts longer than it is."""

from datetime import timedelta
from pathlib import Path

from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from app.access.opening import open_store
from app.access.principal import this_computer
from app.access.sessions import (
    ABSOLUTE,
    PROOF,
    STEP_UP,
    Session,
    SessionState,
    is_proven,
    is_stepped_up,
    state,
)
from app.access.throttle import LONGEST, Failures, wait_left
from app.access.tickets import ONE_SHOT, OneShots
from app.base.clock import SMALL_CORRECTION, is_within, lasts
from tests.access.door import ADDRESS, START, Door
from tests.amount import amount

NONE = timedelta()
small = st.timedeltas(-2 * SMALL_CORRECTION, 2 * SMALL_CORRECTION)
near = st.timedeltas(timedelta(hours=-13), timedelta(hours=13))
far = st.timedeltas(timedelta(days=-20_000), timedelta(days=20_000))
errors = st.one_of(st.just(NONE), small, near, far)
"""How far what is stored lies ahead of the clock that reads it."""
laters = st.one_of(
    st.timedeltas(NONE, 2 * PROOF),
    st.timedeltas(NONE, 2 * ABSOLUTE),
    st.timedeltas(NONE, timedelta(days=20_000)),
)
counts = st.integers(1, 2000)


def session(began: timedelta, used: timedelta, proven: timedelta) -> Session:
    return Session("d", "ada", "", ADDRESS, "", START + began, START + used, START + proven)


def cabinet(stepped: timedelta) -> Session:
    return Session("k", "", "t", ADDRESS, "", START, START, START, START + stepped)


@settings(
    deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=amount(12, 80)
)
@given(errors, errors, errors, errors, errors, counts, laters)
@example(NONE, NONE, NONE, NONE, NONE, 4, NONE)
@example(PROOF, PROOF, PROOF, PROOF, PROOF, 50, PROOF)
def test_no_span_lasts_longer_from_the_begin_of_a_process(
    tmp_path: Path,
    began: timedelta,
    used: timedelta,
    proven: timedelta,
    stepped: timedelta,
    failed: timedelta,
    count: int,
    later: timedelta,
) -> None:
    door = Door(tmp_path)
    store = open_store(door.settings)
    with store.writing() as change:
        change.empty()
        change.put_session(session(began, used, proven))
        change.put_session(cabinet(stepped))
        change.put_failures("address:" + ADDRESS, Failures(count, START + failed))
    door.keeper.close()
    door = Door(tmp_path)
    book, now = door.keeper.book, START + later
    person = book.sessions.get("d")
    if person is not None and state(person, now) is not SessionState.ENDED:
        assert later < ABSOLUTE
        assert not is_proven(person.proven_at, now) or later < PROOF
    assert not is_stepped_up(book.sessions["k"], now) or later < STEP_UP
    wait = wait_left(store.failures(["address:" + ADDRESS]).values(), now)
    assert wait <= max(LONGEST - later, NONE)
    store.close()
    door.keeper.close()


@given(errors, errors, errors, counts)
def test_no_span_lasts_longer_under_a_clock_that_is_set_while_a_process_runs(
    began: timedelta, used: timedelta, proven: timedelta, count: int
) -> None:
    one = session(began, used, proven)
    if state(one, START) is not SessionState.ENDED:
        assert max(began, used) <= SMALL_CORRECTION
        assert began > -ABSOLUTE
    assert is_proven(one.proven_at, START) == (-PROOF < proven <= NONE)
    assert is_stepped_up(cabinet(proven), START) == (NONE < proven <= STEP_UP)
    assert wait_left([Failures(count, START + began), Failures(count, START + used)], START) <= LONGEST


@given(errors)
def test_a_ticket_opens_for_five_seconds_under_every_clock(ahead: timedelta) -> None:
    tickets, who = OneShots(), this_computer("127.0.0.1")
    found = tickets.redeem(tickets.issue(who, START + ahead), START)
    assert found == (who if -ONE_SHOT < ahead <= NONE else None)


@given(errors, st.timedeltas(NONE, ABSOLUTE), st.timedeltas(NONE, SMALL_CORRECTION))
def test_what_lies_in_the_future_has_ended(at: timedelta, span: timedelta, ahead: timedelta) -> None:
    assert is_within(START + at, START, span, ahead=ahead) == (-span < at <= ahead)
    assert lasts(START + at, START, span) == (NONE < at <= span)
