"""Which positions are believed: the range, the way an axis can have turned, and two readings that agree."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.base.clock import VirtualClock
from app.drives.plausibility import Plausibility
from app.drives.register import Register, WordType
from app.modbus.errors import DriveError
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import AxisFeedback, Feedback

CONFIG = TrackerConfig("T1", "North")
REGISTERS = {
    Axis.AZIMUTH: Register("azimuth", 0, WordType.INT32, minimum=-180.0, maximum=180.0),
    Axis.ELEVATION: Register("elevation", 2, WordType.INT32, minimum=-10.0, maximum=100.0),
}
FAR_IN_A_SECOND = {axis: CONFIG.axis(axis).speed_dps * 1.5 + 0.5 for axis in Axis}


def reading(azimuth_deg: float = 10.0, elevation_deg: float = 20.0) -> Feedback:
    azimuth, elevation = (
        AxisFeedback(at, 0.0, moving=False, homed=True) for at in (azimuth_deg, elevation_deg)
    )
    return Feedback(azimuth, elevation, boot_count=3)


@pytest.fixture
def clock() -> VirtualClock:
    return VirtualClock(datetime(2026, 6, 21, 12, tzinfo=UTC))


@pytest.fixture
def held(clock: VirtualClock) -> Plausibility:
    """Return what holds readings against one that was taken a second ago."""
    found = Plausibility(CONFIG, clock, REGISTERS)
    found.accept(reading())
    clock.advance(timedelta(seconds=1))
    return found


def test_the_first_reading_needs_the_range_alone(clock: VirtualClock) -> None:
    first = Plausibility(CONFIG, clock, REGISTERS)
    assert first.doubt(reading(180.0, 100.0)) is None
    assert first.doubt(reading(180.5)) == (
        "The drive reports azimuth 180.5 degrees, outside the profile's range of -180 to 180."
    )
    assert first.doubt(reading(0.0, -11.0)) == (
        "The drive reports elevation -11 degrees, outside the profile's range of -10 to 100."
    )


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_an_axis_turns_at_most_half_again_as_fast_as_rated_and_half_a_degree(
    held: Plausibility, way: float
) -> None:
    azimuth, elevation = (way * FAR_IN_A_SECOND[axis] for axis in (Axis.AZIMUTH, Axis.ELEVATION))
    assert held.doubt(reading(10.0 + azimuth * 0.999, 20.0 + elevation * 0.999)) is None
    moved_deg = abs(azimuth) * 1.1
    assert held.doubt(reading(10.0 + azimuth * 1.1)) == (
        f"The drive reports that azimuth moved by {moved_deg:.2f} degrees in 1.00 s, faster than it can turn."
    )
    assert "elevation moved by" in str(held.doubt(reading(10.0, 20.0 + elevation * 1.1)))


def test_the_way_is_measured_from_the_last_accepted_reading(held: Plausibility, clock: VirtualClock) -> None:
    far = reading(10.0 + FAR_IN_A_SECOND[Axis.AZIMUTH] * 1.5)
    assert held.doubt(far) is not None
    clock.advance(timedelta(seconds=1))
    assert held.doubt(far) is None
    held.accept(far)
    assert held.doubt(reading()) is not None


def test_a_restart_a_request_or_another_home_may_have_moved_the_zero(held: Plausibility) -> None:
    far = reading(90.0, 80.0)
    for changed in (
        replace(far, boot_count=4),
        replace(far, request_done=1),
        replace(far, azimuth=replace(far.azimuth, homed=False)),
        replace(far, elevation=replace(far.elevation, homed=False)),
    ):
        assert held.doubt(changed) is None
    assert held.doubt(far) is not None
    assert "outside" in str(held.doubt(replace(reading(190.0), boot_count=4)))


def test_two_readings_that_agree_are_believed_and_two_that_do_not_are_damage(held: Plausibility) -> None:
    far = reading(90.0)
    assert held.settle(far, reading(90.5)) == reading(90.5)
    assert held.settle(far, reading(10.2)) == reading(10.2), "the second is good"
    with pytest.raises(DriveError) as refused:
        held.settle(far, reading(90.51))
    assert str(refused.value) == (
        "The drive reports that azimuth moved by 80.51 degrees in 1.00 s, faster than it can turn. "
        "The reading was rejected. Check the encoder and network."
    )
    with pytest.raises(DriveError, match="outside"):
        held.settle(reading(200.0), reading(200.0))
