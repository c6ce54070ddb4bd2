"""What a heartbeat is worth: how late it is beyond the quickest one, and which presses are dead for ever."""

from datetime import datetime, timedelta

import pytest

from app.tracker.commands.commands import JOG_LEASE
from app.web.live.hold_to_run import (
    LATEST_HEARTBEAT,
    MOST_DEAD,
    MOST_LIVE,
    SLOWEST_ROUND_TRIP,
    Dead,
    Heartbeat,
    LinkDelay,
    Presses,
    Verdict,
)
from tests.fake_data import NOON

NOTHING = timedelta()
QUICK = timedelta(milliseconds=5)
MILLISECOND = timedelta(milliseconds=1)


class Page:
    """Presses of one connection whose messages take 20 ms, and some longer."""

    def __init__(self) -> None:
        self.dead = Dead()
        self.presses = Presses(LinkDelay(), self.dead)
        self.judge("first", late=NOTHING)
        self.presses.end("first")

    def judge(
        self,
        press_id: str,
        sequence: int = 0,
        *,
        at: timedelta = NOTHING,
        late: timedelta = NOTHING,
        round_trip: timedelta | None = QUICK,
    ) -> tuple[Verdict, timedelta]:
        arrived = NOON + at + late
        sent_ms = (at - timedelta(milliseconds=20)) / MILLISECOND
        return self.presses.judge(Heartbeat(press_id, "T" + press_id, sequence, sent_ms, arrived, round_trip))


def ms(delay: timedelta) -> float:
    return delay / MILLISECOND


def test_a_message_is_late_by_what_it_takes_beyond_the_quickest() -> None:
    delay = LinkDelay()

    def late_ms(sent_s: float, takes_ms: float) -> float:
        arrived = NOON + timedelta(seconds=sent_s, milliseconds=takes_ms)
        return ms(delay.beyond_best(sent_s * 1000.0, arrived))

    assert late_ms(0.0, 50.0) == 0.0
    assert late_ms(0.1, 80.0) == pytest.approx(30.0, abs=0.1)
    assert late_ms(0.2, 20.0) == 0.0, "quicker than all before"
    assert late_ms(0.3, 80.0) == pytest.approx(60.0, abs=0.1)
    assert late_ms(100.0, 80.0) == pytest.approx(60.0 - 20.0, abs=0.1), "a clock drifts 20 ms in 100 s"
    assert late_ms(200.0, 80.0) == pytest.approx(60.0 - 40.0, abs=0.1)


def test_a_clock_of_the_browser_that_is_hours_off_changes_nothing() -> None:
    delay = LinkDelay()
    hours: datetime = NOON + timedelta(hours=9)
    assert delay.beyond_best(0.0, hours) == NOTHING
    assert ms(delay.beyond_best(50.0, hours + timedelta(milliseconds=90))) == pytest.approx(40.0, abs=0.1)


@pytest.mark.parametrize("late_ms", [0, 1, 119, 120])
def test_what_a_heartbeat_was_late_is_taken_off_its_lease(late_ms: int) -> None:
    late = timedelta(milliseconds=late_ms)
    verdict, lease = Page().judge("p", late=late)
    assert verdict is Verdict.RENEW
    assert ms(lease) == pytest.approx(ms(JOG_LEASE) - late_ms, abs=0.1)


def test_a_heartbeat_that_is_too_late_begins_nothing_and_renews_nothing() -> None:
    page, late = Page(), LATEST_HEARTBEAT + MILLISECOND
    assert page.judge("p", late=late) == (Verdict.TOO_SLOW, NOTHING)
    assert page.judge("q")[0] is Verdict.RENEW
    assert page.judge("q", 1, at=50 * MILLISECOND, late=late) == (Verdict.IGNORE, NOTHING)
    assert page.judge("q", 2, at=239 * MILLISECOND)[0] is Verdict.RENEW, "the press itself lives on"
    assert timedelta(milliseconds=120) == LATEST_HEARTBEAT


def test_a_slow_round_trip_begins_nothing_and_renews_nothing() -> None:
    page = Page()
    slow = SLOWEST_ROUND_TRIP + MILLISECOND
    assert page.judge("p", round_trip=slow) == (Verdict.TOO_SLOW, NOTHING)
    assert page.judge("q", round_trip=SLOWEST_ROUND_TRIP)[0] is Verdict.RENEW
    assert page.judge("q", 1, at=MILLISECOND, round_trip=slow) == (Verdict.IGNORE, NOTHING)


def test_a_press_begins_once_the_connection_was_measured_and_goes_on_without() -> None:
    page = Page()
    assert page.judge("p", round_trip=None) == (Verdict.UNMEASURED, NOTHING)
    assert page.judge("p")[0] is Verdict.RENEW
    assert page.judge("p", 1, at=MILLISECOND, round_trip=None)[0] is Verdict.RENEW


def test_heartbeats_that_overtook_each_other_count_once() -> None:
    page = Page()
    for sequence, verdict in ((3, Verdict.RENEW), (3, Verdict.IGNORE), (2, Verdict.IGNORE)):
        assert page.judge("p", sequence)[0] is verdict
    assert page.judge("p", 4)[0] is Verdict.RENEW


def test_a_press_that_ran_out_is_dead_at_that_instant() -> None:
    page = Page()
    page.judge("p")
    assert page.judge("p", 1, at=JOG_LEASE - MILLISECOND)[0] is Verdict.RENEW
    assert page.judge("p", 2, at=JOG_LEASE - MILLISECOND + JOG_LEASE) == (Verdict.DEAD, NOTHING)
    assert "p" in page.dead
    assert page.judge("p", 3, at=timedelta(hours=1))[0] is Verdict.DEAD


def test_the_lateness_of_its_last_heartbeat_shortens_a_press() -> None:
    page, late = Page(), timedelta(milliseconds=100)
    page.judge("p", late=late)
    end = page.presses.end_all(NOON + JOG_LEASE - MILLISECOND)
    assert end == [("Tp", "p")], "it counts from when it was sent"
    page.judge("q", late=late)
    assert page.presses.end_all(NOON + JOG_LEASE + MILLISECOND) == []
    assert "q" in page.dead


def test_a_press_that_was_let_go_is_dead_on_every_connection() -> None:
    page = Page()
    page.judge("p")
    assert page.presses.end("p")
    assert not page.presses.end("p")
    assert not page.presses.end("never seen")
    assert page.judge("p", 1)[0] is Verdict.DEAD
    other = Presses(LinkDelay(), page.dead)
    assert other.judge(Heartbeat("never seen", "T1", 0, 0.0, NOON, QUICK))[0] is Verdict.DEAD


def test_who_leaves_ends_everything_that_is_held() -> None:
    page = Page()
    page.judge("p")
    page.judge("q")
    assert page.presses.end_all(NOON) == [("Tp", "p"), ("Tq", "q")]
    assert page.presses.end_all(NOON) == []
    assert "p" in page.dead
    assert "q" in page.dead


def test_of_too_many_presses_at_once_the_oldest_ends() -> None:
    page = Page()
    for number in range(MOST_LIVE):
        page.judge(str(number))
    assert page.judge("0", 1)[0] is Verdict.RENEW, "one that is known ends none"
    page.judge("one more")
    assert "0" in page.dead
    assert "1" not in page.dead
    assert len(page.presses.end_all(NOON)) == MOST_LIVE


def test_ten_thousand_dead_presses_are_remembered_and_the_oldest_forgotten() -> None:
    dead = Dead()
    for number in range(MOST_DEAD):
        dead.bury(str(number))
    assert "0" in dead
    dead.bury("one more")
    assert "0" not in dead
    assert "1" in dead
    assert "one more" in dead
