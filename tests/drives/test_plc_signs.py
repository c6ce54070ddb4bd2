"""Signs of life on readings made up: the first one says nothing, and each sentence says which drive."""

from dataclasses import replace

import pytest

from app.drives.dialects.plc_signs import MOST_UNCHANGED, SignsOfLife
from app.drives.profile import Profile, load_profile
from app.modbus.errors import DriveError
from app.tracker.values.motion import AxisFeedback, Feedback

PROFILE = load_profile("simulated-plc")
FIRST = 2
REST = AxisFeedback(0.0, 0.0, moving=False, homed=True)
STILL = Feedback(REST, REST, 1)
TURNING = Feedback(replace(REST, moving=True), REST, 1)
RISING = Feedback(REST, replace(REST, moving=True), 1)


def signs(profile: Profile = PROFILE) -> SignsOfLife:
    return SignsOfLife(profile, lambda: "10.0.0.5 unit 3")


def words(*, heartbeat: int = 0, echo: int = 0, watchdog_ms: int = 500) -> list[int]:
    return [heartbeat, echo, *[0] * 13, watchdog_ms]


def test_a_heartbeat_may_stand_still_for_three_readings_after_the_first() -> None:
    life = signs()
    for _ in range(MOST_UNCHANGED):
        life.watch(words(heartbeat=7), FIRST)
    with pytest.raises(
        DriveError, match=r"^The drive at 10.0.0.5 unit 3 answers, but its heartbeat does not change"
    ):
        life.watch(words(heartbeat=7), FIRST)
    life.watch(words(heartbeat=8), FIRST)


def test_an_echo_counts_only_where_a_value_was_taken_in_between() -> None:
    life = signs()
    for beat in range(20):
        life.watch(words(heartbeat=beat, echo=5), FIRST)
    for beat in range(MOST_UNCHANGED):
        life.fed()
        life.watch(words(heartbeat=30 + beat, echo=5), FIRST)
        life.watch(words(heartbeat=50 + beat, echo=5), FIRST)
    life.fed()
    with pytest.raises(DriveError, match=r"^The drive at 10.0.0.5 unit 3 answers, but does not echo"):
        life.watch(words(heartbeat=99, echo=5), FIRST)


@pytest.mark.parametrize("turning", [TURNING, RISING])
def test_a_watchdog_that_was_never_on_ends_no_motion(turning: Feedback) -> None:
    life = signs()
    assert life.watchdog_s == PROFILE.watchdog.timeout_ms / 1000.0  # type: ignore[union-attr]
    life.watch_watchdog(words(watchdog_ms=0), FIRST, turning)
    life.watch_watchdog(words(watchdog_ms=0), FIRST, turning)
    assert life.watchdog_s is None
    life.watch_watchdog(words(watchdog_ms=1), FIRST, turning)
    assert life.watchdog_s == 0.001
    life.watch_watchdog(words(watchdog_ms=0), FIRST, STILL)
    with pytest.raises(DriveError, match=r"10.0.0.5 unit 3 was switched off during motion"):
        life.watch_watchdog(words(watchdog_ms=0), FIRST, turning)


def test_a_profile_without_a_watchdog_or_without_its_reading_is_not_watched() -> None:
    assert PROFILE.watchdog is not None
    for watchdog in (None, replace(PROFILE.watchdog, readback=None)):
        life = signs(replace(PROFILE, watchdog=watchdog))
        life.watch_watchdog(words(watchdog_ms=500), FIRST, STILL)
        life.watch_watchdog(words(watchdog_ms=0), FIRST, TURNING)
        assert life.watchdog_s == (None if watchdog is None else watchdog.timeout_ms / 1000.0)
