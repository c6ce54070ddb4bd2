"""Numbers that fit no register of a drive: refused when settings are saved, later a fault of the drive."""

from contextlib import suppress
from dataclasses import replace
from itertools import count
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.base.message import N_
from app.drives.dialects.extremes import extremes
from app.drives.dialects.gearing import gearing_of
from app.drives.dialects.register_axis import RegisterAxis
from app.drives.dialects.two_axes import TwoAxisDrive
from app.drives.drive import check_fit
from app.drives.profile import PROFILES, load_profile
from app.drives.register import ValueMisfit
from app.drives.unit import Unit
from app.link.messages import AddTracker, CheckConnection, ConfigureTracker
from app.machine.drive_factory import DriveFactory
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site, SiteOptions
from app.site.state.connection_test import Checks
from app.tracker.commands.commands import CommandRejected, Jog, ResetFault, Stop
from app.tracker.memory.drive_check import CheckOutcome, DriveReadings
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis, AxisConfig, JogSpeed
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind, Orientation, TrackerConfig
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.motion import DriveCommand
from tests.drives.direct_link import DIALECTS, DirectLink
from tests.golden.table import rows
from tests.site.plant import SUMMER_NOON, Plant

ROWS = rows("world/drive_numbers.csv")
IDS = [f"{row['profile']}: {row['why']}" for row in ROWS]
MISFITS = [row for row in ROWS if row["register"]]
EVERY = pytest.mark.parametrize("row", ROWS, ids=IDS)
PORTS = count(1502)


def config_of(row: dict[str, str], tracker_id: str = "T1") -> TrackerConfig:
    """Return a tracker whose azimuth is as the row says, on a line of its own."""
    inside_deg = min(float(row["maximum_deg"]), 180.0)
    axis = AxisConfig(
        float(row["minimum_deg"]),
        float(row["maximum_deg"]),
        float(row["speed_dps"]),
        float(row["acceleration_dps2"]),
        float(row["jog_slow_dps"]),
        float(row["jog_slow_dps"]),
    )
    steps = float(row["steps"]) if row["steps"] else None
    own = AxisDrive(None, steps, float(row["gear_ratio"]), row["inverted"] == "yes")
    usual = (
        AxisDrive(unit=2, gear_ratio=60.0) if load_profile(row["profile"]).adapter.has_unit_per_axis else own
    )
    name = "edited" if row["edit"] else row["profile"]
    drive = DriveConfig(DriveKind.MODBUS_TCP, name, port=next(PORTS), azimuth=own, elevation=usual)
    return TrackerConfig(
        tracker_id, "Tracker", azimuth=axis, drive=drive, park=Orientation(inside_deg % 360.0, 90.0)
    )


def factory_of(row: dict[str, str], folder: Path, clock: VirtualClock) -> DriveFactory:
    """Return a factory that knows the profile of the row, edited where it says so."""
    if row["edit"]:
        text = (PROFILES / f"{row['profile']}.toml").read_text(encoding="utf-8")
        old, new = row["edit"].split(" => ")
        assert old in text
        (folder / "profiles").mkdir()
        edited = text.replace(old, new).replace(f'name = "{row["profile"]}"', 'name = "edited"')
        (folder / "profiles" / "edited.toml").write_text(edited, encoding="utf-8")
    return DriveFactory(clock, folder)


def plant_of(row: dict[str, str], folder: Path) -> Plant:
    """Return a site with a simulated tracker, whose drives are made as in a real controller."""
    clock = VirtualClock(SUMMER_NOON)
    factory = factory_of(row, folder, clock)
    first = TrackerState(TrackerConfig("T1", "Tracker 1"), TrackerMemory())
    return Plant(clock, Site(clock, factory.make, SiteState(), (first,), options=SiteOptions()), {})


def refused(row: dict[str, str], error: ValueError) -> bool:
    """Return whether an error names the register, its number and what to change."""
    text = str(error)
    return f"register {row['register']}" in text and f"{row['change']}" in text and "azimuth axis" in text


@EVERY
@pytest.mark.parametrize("order", [ConfigureTracker, AddTracker])
async def test_settings_whose_numbers_do_not_fit_are_not_saved(
    order: type[ConfigureTracker | AddTracker], row: dict[str, str], tmp_path: Path
) -> None:
    plant = plant_of(row, tmp_path)
    await plant.start()
    tracker_id = "T1" if order is ConfigureTracker else "T2"
    wanted = config_of(row, tracker_id)
    if row["register"]:
        with pytest.raises(ValueError, match="register") as refusal:
            await plant.ask(order(wanted))
        assert refused(row, refusal.value), str(refusal.value)
        assert plant.site.model.tracker("T1").config.drive == DriveConfig()
    else:
        await plant.ask(order(wanted))
        assert plant.site.model.tracker(tracker_id).config == wanted
    await plant.close()


@EVERY
async def test_what_is_saved_fits_when_it_is_commanded(row: dict[str, str], tmp_path: Path) -> None:
    """The dry run and the run agree: every extreme command goes out, or names the same register."""
    if not load_profile(row["profile"]).adapter.has_unit_per_axis:
        return
    clock = VirtualClock(SUMMER_NOON)
    config = config_of(row)
    drive = stepping_drive(config, clock)
    misfits = []
    for command in extremes(config.azimuth):
        drive = stepping_drive(config, clock)
        await drive.read()
        try:
            await drive.write(DriveCommand(azimuth=command))
        except ValueMisfit as misfit:
            misfits.append(str(misfit))
    if not row["register"]:
        assert not misfits
        check_fit(drive)
        return
    with pytest.raises(ValueMisfit):
        check_fit(drive)


def stepping_drive(config: TrackerConfig, clock: VirtualClock) -> TwoAxisDrive:
    """Return a tracker's drive with a direct link to the simulated device of each axis."""
    profile = load_profile(config.drive.profile)
    found = devices(profile, SimulatedDrive(config, clock, watchdog=None), clock, 1)
    axes: dict[Axis, RegisterAxis] = {}
    for axis, number in zip(Axis, (1, 2), strict=True):
        unit, own = Unit(profile, DirectLink(found[number]), str(axis)), config.axis(axis)
        gearing = gearing_of(profile, config.drive.axis(axis))
        dialect = DIALECTS[profile.adapter](unit, gearing, own.acceleration_dps2)
        axes[axis] = RegisterAxis(dialect, unit, gearing, own, clock)
    return TwoAxisDrive(config, profile, axes, clock, "here")


STEPPED = [row for row in MISFITS if load_profile(row["profile"]).adapter.has_unit_per_axis]


@pytest.mark.parametrize("row", STEPPED, ids=[f"{row['profile']}: {row['why']}" for row in STEPPED])
async def test_stored_settings_that_do_not_fit_are_a_fault_of_the_drive(row: dict[str, str]) -> None:
    """Settings of an earlier version, or of a backup: nothing refused them, and the drive still stops."""
    clock = VirtualClock(SUMMER_NOON)
    config = replace(config_of(row), tracker_id="T1")
    state = TrackerState(config, TrackerMemory())
    site = Site(clock, lambda one: stepping_drive(one, clock), SiteState(), (state,), options=SiteOptions())
    plant = Plant(clock, site, {})
    await plant.start()
    await plant.forward(seconds=1)
    for turn in range(3):
        with suppress(CommandRejected):
            await plant.ask(Jog(f"press{turn}", Axis.AZIMUTH, 1, JogSpeed.FAST))
        await plant.forward(seconds=0.4)
    await plant.ask(Stop())
    await plant.forward(seconds=1)
    assert plant.site.alive
    loop = plant.site.model.tracker("T1")
    assert loop.broken is None
    assert (await loop.stop_drive()) is True
    fault = plant.tracker().fault
    is_commanded = row["register"].endswith("acceleration") and "becomes zero" not in row["why"]
    assert (fault is not None) == is_commanded, "a jog writes the ramp, and only a part of the other numbers"
    if fault is not None:
        assert fault.code == "command_refused"
        assert "does not fit into register" in fault.message
    await plant.close()


async def test_gear_left_at_one_is_a_fault_that_names_the_register_and_can_be_reset() -> None:
    clock = VirtualClock(SUMMER_NOON)
    config = config_of(MISFITS[0])
    state = TrackerState(config, TrackerMemory())
    site = Site(clock, lambda one: stepping_drive(one, clock), SiteState(), (state,), options=SiteOptions())
    plant = Plant(clock, site, {})
    await plant.start()
    await plant.forward(seconds=1)
    await plant.ask(Jog("press", Axis.AZIMUTH, 1, JogSpeed.FAST))
    await plant.forward(seconds=0.4)
    seen = plant.tracker()
    assert seen.activity is ActivityName.FAULTED
    assert seen.fault is not None
    assert seen.fault.code == "command_refused"
    assert seen.fault.message == (
        "The drive of Tracker was not given its command: 1000000 does not fit into register "
        "path_acceleration (25092), which holds 0 to 65535 ms/1000rpm. Change the acceleration or the gear "
        "ratio of the azimuth axis."
    )
    await plant.ask(ResetFault())
    await plant.forward(seconds=2)
    assert plant.tracker().activity is ActivityName.HOLDING
    await plant.close()


async def test_what_is_stored_and_does_not_fit_refuses_no_other_setting(tmp_path: Path) -> None:
    """A kept tracker is still renamed and protected; its speeds and its drive are saved once they fit."""
    row = MISFITS[0]
    clock = VirtualClock(SUMMER_NOON)
    kept = config_of(row)
    factory = factory_of(row, tmp_path, clock)
    state = TrackerState(kept, TrackerMemory())
    plant = Plant(clock, Site(clock, factory.make, SiteState(), (state,), options=SiteOptions()), {})
    await plant.start()
    named = replace(kept, name="North")
    await plant.ask(ConfigureTracker(named))
    assert plant.site.model.tracker("T1").config == named
    narrowed = replace(named, azimuth=replace(named.azimuth, maximum_deg=350.0))
    with pytest.raises(ValueError, match="the acceleration or the gear ratio of the azimuth axis"):
        await plant.ask(ConfigureTracker(narrowed))
    geared = replace(named.drive, azimuth=replace(named.drive.azimuth, gear_ratio=60.0))
    await plant.ask(ConfigureTracker(replace(narrowed, drive=geared)))
    assert plant.site.model.tracker("T1").config.drive == geared
    await plant.close()


class Answering(Checks):
    """A connection test that always finds the drive."""

    async def look(self, drive: DriveConfig) -> DriveReadings:
        return DriveReadings(CheckOutcome.ANSWERED, N_("The device answers: 34 registers were read."))


async def test_the_connection_test_says_what_does_not_fit(tmp_path: Path) -> None:
    plant = plant_of(MISFITS[0], tmp_path)
    plant.site.model.checks = Answering()
    await plant.start()
    await plant.ask(CheckConnection("T1", config_of(MISFITS[0]).drive))
    kept = plant.site.model.checks.newest("T1")
    assert kept is not None
    assert str(kept.readings.message).startswith(
        "The device answers: 34 registers were read. 1000000 does not"
    )
    await plant.close()
