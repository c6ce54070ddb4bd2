"""What belongs to the whole site: orders, trackers, faults that stay where they arise, the clock."""

import asyncio
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.base.angles import separation_deg
from app.base.clock import VirtualClock
from app.drives.drive import Drive
from app.link.messages import (
    AddTracker,
    ApplySightings,
    ConfigureTracker,
    ConfirmStep,
    DeleteRecording,
    Order,
    RemoveTracker,
    RenameSite,
    SetClock,
    SetLocation,
    StopAll,
    TakeSighting,
    UnknownTracker,
)
from app.link.place_orders import SetHorizon
from app.site.clock.timekeeping import Timekeeper
from app.site.weather.sky import Sky
from app.sun.horizon import Horizon
from app.sun.position import Algorithm, Location
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    Jog,
    Move,
    ResetFault,
    SelectMode,
    Stop,
    Track,
)
from app.tracker.commissioning.steps import StepStatus
from app.tracker.controller import Controller, Tick
from app.tracker.memory.memory import ClockSetting, StepName, TrackerMemory, TrackerState
from app.tracker.memory.observation import Observation
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import (
    AxisDrive,
    DriveConfig,
    DriveKind,
    Orientation,
    SerialConfig,
    TrackerConfig,
)
from app.tracker.state.snapshot import ActivityName, Event, EventKind
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCapabilities
from tests.fault_result import FaultResult
from tests.site.plant import FIRST, SAMSUN, SUMMER_NOON, Begun, Plant, make_plant, settle
from tests.site.wrapped_drive import WrappedDrive, wrapped

SECOND = TrackerState(TrackerConfig("T2", "Tracker 2"), TrackerMemory())


class BrokenController(Controller):
    """A state that fails at whatever it is asked."""

    def __init__(self, state: TrackerState) -> None:
        super().__init__(state.config, state.memory, DriveCapabilities(True, None, True, True, "", True))

    def handle(self, command: Command, now: datetime, actor: str = "operator") -> tuple[Event, ...]:
        raise RuntimeError("a programming error")

    def tick(self, seen: Observation) -> Tick:
        raise RuntimeError("a programming error")


async def test_a_repeated_order_is_carried_out_once_and_answers_as_the_first(plant: Plant) -> None:
    first = await plant.ask(RenameSite("Samsun"), key="k1")
    again = await plant.ask(RenameSite("Samsun"), key="k1")

    assert again == first
    assert len(plant.happened(EventKind.TRACKER_CHANGED)) == 1


async def test_a_repeated_order_that_was_refused_is_refused_again(plant: Plant) -> None:
    for _ in range(2):
        with pytest.raises(CommandRejected):
            await plant.ask(Track(), key="k2")
    assert (await plant.site.metrics()).orders_refused == 2


async def test_an_order_that_is_too_old_is_refused_but_not_stop(plant: Plant) -> None:
    old = plant.clock.now() - timedelta(seconds=3)

    with pytest.raises(CommandRejected) as refused:
        await plant.ask(Jog("p", Axis.AZIMUTH, 1), issued_at=old)
    await plant.ask(Stop(), issued_at=old)

    assert refused.value.reasons[0].code == "too_old"
    assert plant.happened(EventKind.STOPPED)


@pytest.mark.parametrize(
    ("ahead_s", "code"),
    [
        (1.9, None),
        (2.1, "from_the_future"),
        (3600.0, "from_the_future"),
    ],
)
@pytest.mark.fault(90)
async def test_an_order_of_the_future_is_refused_but_not_stop(
    plant: Plant, ahead_s: float, code: str | None, fault: FaultResult
) -> None:
    ahead = plant.clock.now() + timedelta(seconds=ahead_s)
    if code is None:
        await plant.ask(RenameSite("Samsun"), issued_at=ahead)
    for command in (RenameSite("Bafra"), Jog("p", Axis.AZIMUTH, 1)) if code else ():
        with pytest.raises(CommandRejected, match="ahead of the site's clock") as refused:
            await plant.ask(command, issued_at=ahead)
        assert refused.value.reasons[0].code == code
        assert "clock" in refused.value.reasons[0].hint
        if ahead_s == 3600.0:
            fault.shows(str(refused.value))
    await plant.ask(Stop(), issued_at=ahead)
    assert plant.happened(EventKind.STOPPED)
    await plant.ask(RenameSite("Ünye"), issued_at=plant.clock.now())
    fault.prevented("it is refused")
    fault.recovers("the clock is set; the next command is obeyed")


async def test_an_unknown_tracker_is_unknown(plant: Plant) -> None:
    with pytest.raises(UnknownTracker, match="T9"):
        await plant.ask(Track(), "T9")


async def test_trackers_come_and_go(plant: Plant) -> None:
    added = await plant.ask(AddTracker(TrackerConfig("T2", " Second ")))
    with pytest.raises(CommandRejected, match="Tracker T2 already exists"):
        await plant.ask(AddTracker(TrackerConfig("T2", "Again")))
    await plant.forward(seconds=1)
    assert plant.tracker("T2").tick >= 9

    left = await plant.ask(RemoveTracker("T2"))

    assert [tracker.name for tracker in added.trackers] == ["Tracker 1", "Second"]
    assert [tracker.tracker_id for tracker in left.trackers] == ["T1"]


@pytest.mark.parametrize(
    ("config", "message"),
    [
        (TrackerConfig("1 T", "x"), "id is a letter"),
        (TrackerConfig("T2", "  "), "A name has"),
        (TrackerConfig("T2", "x", deadband_deg=0.0), "deadband"),
        (TrackerConfig("T2", "x", in_position_deg=0.6), "must not exceed the deadband"),
        (TrackerConfig("T2", "x", following_error_deg=float("nan")), "Following error must be"),
        (TrackerConfig("T2", "x", park=Orientation(0.0, 120.0)), "park position's elevation"),
        (TrackerConfig("T2", "x", drive=DriveConfig(DriveKind.MODBUS_TCP, port=0)), "port"),
        (TrackerConfig("T2", "x", drive=DriveConfig(DriveKind.MODBUS_TCP, host=" ")), "host"),
        (TrackerConfig("T2", "x", drive=DriveConfig(DriveKind.MODBUS_RTU, unit=0)), "between 1 and 247"),
        (TrackerConfig("T2", "x", drive=DriveConfig(DriveKind.MODBUS_RTU, unit=248)), "between 1 and 247"),
    ],
)
@pytest.mark.fault(24)
async def test_an_implausible_tracker_is_refused(
    plant: Plant, config: TrackerConfig, message: str, fault: FaultResult
) -> None:
    with pytest.raises(ValueError, match=message) as refused:
        await plant.ask(AddTracker(config))
    fault.prevented("refused when saved")
    fault.shows(str(refused.value))
    fault.recovers("with settings that fit")


ON_A_NETWORK = DriveConfig(DriveKind.MODBUS_TCP, port=5999)


def on_a_line(tracker_id: str, unit: int, baud_rate: int = 19200, **axes: AxisDrive) -> TrackerConfig:
    serial = SerialConfig("/dev/ttyNone", baud_rate)
    drive = DriveConfig(DriveKind.MODBUS_RTU, unit=unit, serial=serial, **axes)
    return TrackerConfig(tracker_id, tracker_id, drive=drive)


@pytest.mark.parametrize(
    ("config", "message"),
    [
        (on_a_line("T3", 2), "T2 already uses the drive at /dev/ttyNone, unit 2"),
        (TrackerConfig("T3", "T3", drive=ON_A_NETWORK), "T4 already uses the drive"),
        (on_a_line("T3", 4, elevation=AxisDrive(unit=2)), "already uses the drive"),
        (on_a_line("T3", 4, 9600), "uses line /dev/ttyNone with other settings"),
    ],
)
async def test_no_two_trackers_share_a_drive_and_a_line_has_one_setting(
    config: TrackerConfig, message: str, begun: Begun
) -> None:
    taken = (on_a_line("T2", 2), TrackerConfig("T4", "T4", drive=ON_A_NETWORK))
    plant = await begun(trackers=(FIRST, *(TrackerState(one, TrackerMemory()) for one in taken)))

    with pytest.raises(CommandRejected, match=message):
        await plant.ask(AddTracker(config))
    await plant.ask(AddTracker(on_a_line("T3", 4)))


async def test_a_moving_tracker_is_neither_changed_nor_removed(plant: Plant) -> None:
    await plant.ask(Jog("p", Axis.AZIMUTH, 1, JogSpeed.FAST))
    await plant.forward(seconds=0.1)

    for command in (RemoveTracker("T1"), ConfigureTracker(TrackerConfig("T1", "Other"))):
        with pytest.raises(CommandRejected, match="is being jogged"):
            await plant.ask(command)


async def test_a_new_name_keeps_the_zero_and_another_drive_loses_it(plant: Plant) -> None:
    await plant.commission()
    config = plant.site.model.tracker("T1").config

    await plant.ask(ConfigureTracker(replace(config, name="North", deadband_deg=0.4)))
    assert plant.tracker().homed

    other = DriveConfig(DriveKind.SIMULATED, profile="another")
    await plant.ask(ConfigureTracker(replace(config, drive=other)))
    await plant.forward(seconds=1)

    assert not plant.tracker().homed
    assert "another drive" in plant.site.model.tracker("T1").memory.home_lost


async def test_a_fault_in_one_tracker_s_tick_stops_that_one_and_the_other_goes_on(begun: Begun) -> None:
    plant = await begun(trackers=(FIRST, SECOND), wrap=WrappedDrive)
    await plant.ask(Jog("p", Axis.AZIMUTH, 1, JogSpeed.FAST))
    await plant.forward(seconds=0.1)
    wrapped(plant, "T1").nonsense = True
    await plant.forward(seconds=1)

    broken, other = plant.tracker("T1"), plant.tracker("T2")
    assert broken.activity is ActivityName.FAULTED
    assert broken.fault is not None
    assert "RuntimeError" in broken.fault.message
    assert wrapped(plant, "T1").stops > 5
    assert other.activity is ActivityName.HOLDING
    assert other.tick >= 10
    assert len(plant.happened(EventKind.FAULT_RAISED)) == 1
    with pytest.raises(CommandRejected):
        await plant.ask(Jog("q", Axis.AZIMUTH, 1))

    wrapped(plant, "T1").nonsense = False
    await plant.ask(ResetFault())
    await plant.forward(seconds=1)

    assert plant.tracker("T1").activity is ActivityName.HOLDING


async def test_a_drive_that_hangs_holds_up_nobody_else(begun: Begun) -> None:
    plant = await begun(trackers=(FIRST, SECOND), wrap=WrappedDrive)
    await plant.forward(seconds=0.2)
    wrapped(plant, "T1").hangs = True
    before = plant.tracker("T2").tick
    await plant.forward(seconds=2)

    assert plant.tracker("T2").tick >= before + 19


async def test_a_commissioned_tracker_follows_the_sun_until_it_is_stopped(plant: Plant) -> None:
    await plant.track(until=lambda seen: seen.in_position)
    await plant.forward(seconds=30)
    seen = plant.tracker()
    assert seen.activity is ActivityName.TRACKING
    assert seen.measured is not None
    assert seen.sun is not None
    off_deg = separation_deg(
        seen.measured.azimuth_deg,
        seen.measured.elevation_deg,
        seen.sun.azimuth_deg,
        seen.sun.apparent_elevation_deg,
    )
    assert off_deg <= 0.5
    assert seen.off_sun_deg == pytest.approx(off_deg, abs=0.05)
    with pytest.raises(CommandRejected, match="T1 is tracking the sun"):
        await plant.ask(SetLocation(Location(10.0, 10.0), "UTC"))

    await plant.ask(Stop())
    await plant.forward(seconds=3)
    stopped = plant.tracker()
    await plant.forward(seconds=30)

    assert stopped.activity is ActivityName.HOLDING
    assert plant.tracker().measured == stopped.measured
    assert plant.tracker().tracking_on is False
    assert plant.happened(EventKind.STOPPED)[0].actor == "technician"


async def test_the_age_of_a_reading_grows_while_the_next_one_is_waited_for(plant: Plant) -> None:
    await plant.forward(seconds=1.0)
    before = plant.tracker().position_age_s
    assert before is not None
    plant.clock.advance(timedelta(seconds=0.7))
    assert plant.tracker().position_age_s == pytest.approx(before + 0.7)


async def test_a_command_that_is_not_taken_counts_as_no_contact(begun: Begun) -> None:
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=0.2)
    wrapped(plant, "T1").refuses = True
    await plant.forward(seconds=2)

    assert plant.happened(EventKind.DRIVE_LOST)
    assert any("did not take" in notice.message for notice in plant.tracker().notices)
    assert (await plant.site.metrics()).trackers["T1"].write_failures > 0


async def test_stop_all_stops_every_tracker(begun: Begun) -> None:
    plant = await begun(trackers=(FIRST, SECOND), wrap=WrappedDrive)
    for tracker_id in ("T1", "T2"):
        await plant.ask(Jog(f"p{tracker_id}", Axis.ELEVATION, 1, JogSpeed.FAST), tracker_id)
    await plant.forward(seconds=0.1)

    await plant.ask(StopAll())
    await plant.forward(seconds=1)

    assert [wrapped(plant, name).stops for name in ("T1", "T2")] == [1, 1]
    assert all(plant.tracker(name).activity is ActivityName.HOLDING for name in ("T1", "T2"))


async def test_a_drive_that_does_not_hear_stop_holds_up_no_other(begun: Begun) -> None:
    plant = await begun(trackers=(FIRST, SECOND), wrap=WrappedDrive)
    await plant.forward(seconds=0.2)
    wrapped(plant, "T1").deaf = True
    stopping = asyncio.create_task(plant.site.execute(Order(StopAll(), "technician")))
    await settle()

    assert wrapped(plant, "T2").stops == 1
    assert not stopping.done()
    await stopping
    wrapped(plant, "T1").deaf = False


async def test_stop_reaches_the_drive_of_a_tracker_whose_controller_is_broken(begun: Begun) -> None:
    plant = await begun(wrap=WrappedDrive)
    await plant.forward(seconds=0.2)
    plant.site.model.tracker("T1").controller = BrokenController(FIRST)

    await plant.ask(Stop())

    assert wrapped(plant, "T1").stops >= 1
    assert "has failed" in plant.happened(EventKind.STOPPED)[0].message


@pytest.mark.fault(37)
async def test_a_new_location_makes_later_steps_to_be_confirmed(plant: Plant) -> None:
    await plant.commission()
    await plant.ask(SetLocation(Location(40.0, 30.0), "Europe/Istanbul"))
    found = {step.name: step.status for step in (await plant.site.detail()).trackers["T1"].steps}
    assert found[StepName.LOCATION] is StepStatus.DONE
    assert found[StepName.HOMING] is StepStatus.TO_BE_CONFIRMED

    await plant.ask(ConfirmStep("T1", StepName.CLOCK))
    await plant.ask(ConfirmStep("T1", StepName.HOMING))

    again = {step.name: step.status for step in (await plant.site.detail()).trackers["T1"].steps}
    assert again[StepName.CLOCK] is StepStatus.DONE
    assert again[StepName.HOMING] is StepStatus.DONE


async def test_saving_the_same_place_again_changes_no_revision(plant: Plant) -> None:
    await plant.ask(SetLocation(SAMSUN, "Europe/Istanbul"))
    revision = plant.site.model.state.location_revision
    await plant.ask(SetLocation(SAMSUN, "UTC"))

    assert plant.site.model.state.location_revision == revision == 1
    assert plant.site.model.state.time_zone == "UTC"


async def test_what_was_never_done_cannot_be_confirmed(plant: Plant) -> None:
    for step in StepName:
        with pytest.raises(CommandRejected, match="not done yet"):
            await plant.ask(ConfirmStep("T1", step))


async def test_a_time_zone_must_exist(plant: Plant) -> None:
    for zone in ("Mars/Olympus", "", "../../etc/passwd"):
        with pytest.raises(ValueError, match="no time zone"):
            await plant.ask(SetLocation(SAMSUN, zone))


async def test_a_clock_set_by_hand_shows_that_time_and_goes_on(plant: Plant) -> None:
    wanted = plant.clock.now() + timedelta(days=40)
    await plant.ask(SetClock("manual", wanted))
    await plant.forward(seconds=10)

    seen = await plant.ask(RenameSite("Later"))

    assert seen.at == wanted + timedelta(seconds=10)
    assert seen.clock.trusted
    assert seen.clock.offset_s == pytest.approx(40 * 86400)


@pytest.mark.fault(26)
async def test_a_jump_of_the_system_clock_pauses_trust_for_a_minute() -> None:
    drift = [timedelta(0)]
    clock = VirtualClock(SUMMER_NOON)
    keeper = Timekeeper(clock, ClockSetting("system"), drift=lambda: drift[0])
    assert keeper.state().trusted

    drift[0] = timedelta(hours=1)
    jump = keeper.watch()
    assert jump is not None
    assert jump.by == timedelta(hours=1)
    assert not keeper.state().trusted
    assert keeper.now() == SUMMER_NOON + timedelta(hours=1)
    clock.advance(timedelta(seconds=61))
    assert keeper.watch() is None

    assert keeper.state().trusted


async def test_a_clock_set_by_hand_does_not_follow_a_jump_of_the_system() -> None:
    drift = [timedelta(0)]
    clock = VirtualClock(SUMMER_NOON)
    keeper = Timekeeper(clock, ClockSetting("manual", 60.0), drift=lambda: drift[0])
    drift[0] = timedelta(hours=-2)

    assert keeper.watch() is not None
    assert keeper.now() == SUMMER_NOON + timedelta(seconds=60)
    assert keeper.setting.offset_s == 60.0 + 7200.0


@pytest.mark.fault(27)
async def test_a_clock_that_shows_less_than_the_journal_is_not_trusted(fault: FaultResult) -> None:
    clock = VirtualClock(SUMMER_NOON)
    keeper = Timekeeper(clock, ClockSetting("system"), not_before=SUMMER_NOON + timedelta(days=1))
    assert [reason.code for reason in keeper.reasons()] == ["clock_implausible"]

    keeper.adopt(keeper.choose("system", None, "technician"))

    assert keeper.reasons() == ()
    fault.recovers("the clock is set or confirmed")


async def test_the_site_tells_of_a_clock_jump() -> None:
    plant = make_plant()
    drift = [timedelta(0)]
    plant.site.model.timekeeper = Timekeeper(plant.clock, ClockSetting("system"), drift=lambda: drift[0])
    await plant.start()
    drift[0] = timedelta(seconds=-3600)
    await plant.forward(seconds=1)

    assert plant.happened(EventKind.CLOCK_JUMPED)[0].data == {"seconds": -3600.0}
    await plant.close()


async def test_three_sightings_correct_the_pointing(ready: Plant) -> None:
    await ready.ask(SelectMode(Mode.DUAL))
    for _ in range(3):
        seen = ready.latest()
        assert seen.sun is not None
        sun = Orientation(seen.sun.azimuth_deg + 1.0, seen.sun.apparent_elevation_deg - 0.5)
        await ready.ask(Move(sun))
        await ready.until(lambda shown: shown.in_position and shown.activity is ActivityName.HOLDING)
        await ready.ask(TakeSighting("T1"))
        ready.clock.advance(timedelta(hours=2, minutes=20))
        await ready.forward(seconds=1)
    taken = ready.site.model.tracker("T1").memory.sightings
    assert len(taken) == 3

    await ready.ask(ApplySightings("T1", taken))
    pointing = ready.site.model.tracker("T1").memory.pointing
    assert pointing.azimuth_offset_deg == pytest.approx(1.0, abs=0.3)
    assert pointing.residual_deg is not None

    await ready.ask(ApplySightings("T1", ()))
    assert ready.site.model.tracker("T1").memory.pointing.azimuth_offset_deg == 0.0


async def test_a_sighting_needs_sun_and_zero(plant: Plant) -> None:
    with pytest.raises(CommandRejected) as refused:
        await plant.ask(TakeSighting("T1"))

    assert {reason.code for reason in refused.value.reasons} >= {"sun_down", "not_homed", "clock_unset"}


async def test_without_a_store_there_are_no_recordings(plant: Plant) -> None:
    with pytest.raises(CommandRejected, match="without a database"):
        await plant.ask(DeleteRecording("r1"))


async def test_snapshots_come_fast_while_something_moves_and_slowly_at_rest(plant: Plant) -> None:
    async def told(seconds: float) -> int:
        before = plant.latest().sequence
        await plant.forward(seconds=seconds)
        return plant.latest().sequence - before

    assert 8 <= await told(5) <= 12
    await plant.track()
    await plant.forward(seconds=0.2)
    assert 27 <= await told(3) <= 32


async def test_the_next_dawn_is_worked_out_once_and_again_after_it() -> None:
    sky = Sky()
    evening = datetime(2026, 6, 21, 20, tzinfo=UTC)
    first = sky.dawn(SAMSUN, Algorithm.PSA, evening)

    assert first is not None
    assert first.azimuth_deg == pytest.approx(57.2, abs=1.0)
    assert sky.dawn(SAMSUN, Algorithm.PSA, evening + timedelta(hours=1)) is first
    assert sky.dawn(SAMSUN, Algorithm.PSA, evening + timedelta(hours=12)) is not first
    assert sky.dawn(None, Algorithm.PSA, evening) is None
    assert sky.sun(SAMSUN, Algorithm.PSA, datetime(1800, 1, 1, tzinfo=UTC)) is None


async def test_orders_at_the_same_time_do_not_mix(plant: Plant) -> None:
    orders = [Order(SetLocation(Location(40.0 + n, 30.0), "UTC"), "technician") for n in range(5)]
    asking = [asyncio.create_task(plant.site.execute(order)) for order in orders]
    await plant.forward(seconds=0.2)
    await asyncio.gather(*asking)

    assert plant.site.model.state.location_revision == 5


async def test_a_drive_whose_profile_is_gone_leaves_the_site_alive(begun: Begun) -> None:
    def no_drive(_: Drive) -> Drive:
        raise ValueError("There is no profile acme.")

    plant = await begun(wrap=no_drive)
    await plant.forward(seconds=2)

    assert any("no profile acme" in notice.message for notice in plant.tracker().notices)
    assert plant.site.alive


async def test_the_site_counts_as_alive_while_trackers_come_change_and_go(plant: Plant) -> None:
    watched = []

    async def watch() -> None:
        while True:
            watched.append(plant.site.alive)
            await asyncio.sleep(0)

    watching = asyncio.create_task(watch())
    added = TrackerConfig("T2", "Second")
    await plant.ask(AddTracker(added))
    await plant.ask(ConfigureTracker(replace(added, azimuth=replace(added.azimuth, maximum_deg=350.0))))
    await plant.ask(RemoveTracker("T2"))
    watching.cancel()

    assert len(watched) > 30
    assert all(watched)


async def test_a_site_whose_ticker_died_is_not_alive(plant: Plant) -> None:
    def fail(*_: object) -> None:
        raise RuntimeError("a programming error beside the controller")

    plant.site.model.tracker("T1")._on_tick = fail
    await plant.forward(seconds=1)

    assert not plant.site.alive


async def test_the_site_tells_that_the_sun_is_behind_the_entered_horizon(ready: Plant) -> None:
    sun = ready.latest().sun
    assert sun is not None
    assert sun.apparent_elevation_deg > 5.0
    assert not ready.latest().sun_behind_horizon

    wall = Horizon(((0.0, sun.apparent_elevation_deg + 2.0),))
    await ready.ask(SetHorizon(wall))
    assert ready.latest().sun_behind_horizon
    assert ready.site.model.state.horizon == wall
    (event,) = ready.happened(EventKind.HORIZON_SET)
    assert event.message == "The horizon was set: 1 point."

    await ready.ask(SetHorizon(Horizon(((0.0, 1.0),))))
    assert not ready.latest().sun_behind_horizon
