"""Poll period, time-out and loss of a drive follow from the turn of the line that it shares."""

from datetime import timedelta

import pytest

from app.base.clock import VirtualClock
from app.link.messages import AddTracker, ConfigureTracker
from app.machine.drive_factory import DriveFactory
from app.modbus.line_turn import LineTurn
from app.site.loop.line_pace import LinePace, Pace
from app.site.site import Site, SiteOptions
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.memory.observation import SILENCE
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig, TrackerConfig
from tests.site.plant import SUMMER_NOON, Plant

PERIOD = timedelta(milliseconds=100)


def paced(turn: LineTurn | None, *, watchdog_s: float | None = 0.5) -> LinePace:
    line = LinePace(DriveKind.MODBUS_TCP, PERIOD)
    line.follow(turn, watchdog_s)
    return line


def of(devices: int, turn_s: float) -> LineTurn:
    return LineTurn(devices, turn_s, 0.0)


def test_alone_on_its_line_a_drive_is_asked_at_every_tick() -> None:
    for turn in (None, of(1, 0.3)):
        assert paced(turn).pace == Pace(1, pytest.approx(0.08), SILENCE)


def test_one_missed_reading_loses_no_drive_on_a_serial_line() -> None:
    pace = LinePace(DriveKind.MODBUS_RTU, PERIOD).pace
    assert timedelta(seconds=pace.within_s) + PERIOD < pace.silence == SILENCE


@pytest.mark.parametrize(
    ("turn_s", "every"), [(0.05, 1), (0.08, 1), (0.09, 2), (0.2, 3), (0.3, 4), (0.45, 4), (3.0, 4)]
)
def test_a_drive_is_asked_as_seldom_as_the_turn_of_its_line_wants_and_its_watchdog_allows(
    turn_s: float, every: int
) -> None:
    assert paced(of(64, turn_s)).pace.every == every
    assert paced(of(64, 3.0), watchdog_s=None).pace.every == 38, "the line sets the pace alone"


@pytest.mark.parametrize("turn_s", [0.01, 0.1, 0.25])
def test_a_drive_on_a_shared_line_is_lost_with_the_second_missed_reading(turn_s: float) -> None:
    pace = paced(of(64, turn_s)).pace
    period_s, silence_s = pace.every * PERIOD.total_seconds(), pace.silence.total_seconds()
    assert pace.within_s >= 2.0 * turn_s
    assert period_s + pace.within_s < silence_s
    assert silence_s <= 1.2


def test_a_pace_is_not_taken_up_again_before_the_line_is_clearly_faster() -> None:
    line = paced(of(64, 0.09))
    line.follow(of(64, 0.07), 0.5)
    assert line.pace.every == 2
    line.follow(of(64, 0.06), 0.5)
    assert line.pace.every == 1


def test_a_slower_pace_is_said_with_its_period() -> None:
    said = paced(of(64, 0.2)).notice("North")
    assert said is not None
    assert said.message == "The drive of North shares its line with 63 others and is polled every 0.3 s."
    assert paced(of(64, 0.05)).notice("North") is None
    assert paced(None).notice("North") is None


def test_a_line_that_is_too_slow_for_its_watchdogs_is_said() -> None:
    said = paced(of(64, 0.9)).notice("North")
    assert said is not None
    assert said.code == "line_too_slow"
    assert "takes 0.9 s to reach its 64 drives, and each stops automatically after 0.5 s" in said.message


def on_a_line(unit: int, baud_rate: int = 19_200, **other: str) -> TrackerConfig:
    serial = SerialConfig("/dev/ttyNone", baud_rate)
    drive = DriveConfig(DriveKind.MODBUS_RTU, unit=unit, serial=serial, **other)
    return TrackerConfig(f"T{unit}", f"T{unit}", drive=drive)


async def with_drives(count: int, baud_rate: int) -> Plant:
    """Return a running site with so many drives on one serial line."""
    units = range(1, count + 1)
    trackers = tuple(TrackerState(on_a_line(unit, baud_rate), TrackerMemory()) for unit in units)
    clock = VirtualClock(SUMMER_NOON)
    plant = Plant(clock, Site(clock, DriveFactory(clock).make, SiteState(), trackers), {})
    await plant.site.start()
    return plant


@pytest.mark.parametrize(("baud_rate", "room"), [(9_600, 2), (115_200, 14)])
async def test_a_serial_line_takes_as_many_drives_as_their_watchdogs_allow(baud_rate: int, room: int) -> None:
    plant = await with_drives(room - 1, baud_rate)
    await plant.ask(AddTracker(on_a_line(room, baud_rate)))
    with pytest.raises(CommandRejected) as refused:
        await plant.ask(AddTracker(on_a_line(room + 1, baud_rate)))
    (reason,) = refused.value.reasons
    assert reason.code == "line_full"
    assert f"supports at most {room} such drives at {baud_rate} baud" in reason.message
    assert "stops automatically after 0.5 s" in reason.message
    await plant.site.close()


async def test_another_drive_is_refused_on_a_full_line_and_another_name_is_not() -> None:
    plant = await with_drives(6, 19_200)
    await plant.ask(ConfigureTracker(TrackerConfig("T6", "North", drive=on_a_line(6).drive)))
    with pytest.raises(CommandRejected, match="supports at most 4 such drives"):
        await plant.ask(ConfigureTracker(TrackerConfig("T6", "North", drive=on_a_line(7).drive)))
    await plant.site.close()


async def test_a_drive_that_stops_between_two_commands_is_refused_and_told() -> None:
    clock = VirtualClock(SUMMER_NOON)
    options = SiteOptions(boot_id="1", period=timedelta(seconds=1))
    plant = Plant(clock, Site(clock, DriveFactory(clock).make, SiteState(), (), options=options), {})
    await plant.site.start()
    with pytest.raises(CommandRejected) as refused:
        await plant.ask(AddTracker(on_a_line(1)))
    (reason,) = refused.value.reasons
    assert reason.code == "watchdog_short"
    assert reason.hint == "Set its watchdog to at least 1.25 s, or set HELIOPANEL_TICK_MS to 400 or less."
    line = LinePace(DriveKind.MODBUS_TCP, timedelta(seconds=1))
    line.follow(None, 0.5)
    assert line.notice("T1") == reason
    line.follow(None, 1.25)
    assert line.notice("T1") is None
    await plant.site.close()


async def test_drives_without_a_watchdog_are_never_too_many() -> None:
    plant = await with_drives(0, 19_200)
    for unit in range(1, 9):
        await plant.ask(AddTracker(on_a_line(unit, profile="sunspec-601")))
    await plant.site.close()
