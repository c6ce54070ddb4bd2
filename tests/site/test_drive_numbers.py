"""Numbers that fit no register of a drive: refused when settings are saved, later a fault of the drive."""

from collections.abc import Callable
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
from app.drives.drive import Drive, check_fit
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
from tests.site.plant import SUMMER_NOON, Begun, Plant

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


@EVERY
async def test_settings_whose_numbers_do_not_fit_are_not_saved(
    row: dict[str, str], tmp_path: Path, begun: Begun
) -> None:
    plant = await begun(plant_of(row, tmp_path))
    for order, tracker_id in ((ConfigureTracker, "T1"), (AddTracker, "T2")):
        wanted = config_of(row, tracker_id)
        if not row["register"]:
            await plant.ask(order(wanted))
            assert plant.site.model.tracker(tracker_id).config == wanted
            continue
        with pytest.raises(ValueError, match=f"register {row['register']}") as refusal:
            await plant.ask(order(wanted))
        assert row["change"] in str(refusal.value)
        assert "azimuth axis" in str(refusal.value)
        assert plant.site.model.tracker("T1").config.drive == DriveConfig()


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
async def test_stored_settings_that_do_not_fit_are_a_fault_of_the_drive(
    row: dict[str, str], begun: Begun
) -> None:
    """Settings of an earlier version, or of a backup: nothing refused them, and the drive still stops."""
    clock = VirtualClock(SUMMER_NOON)
    plant = await begun(kept_plant(row, clock, lambda one: stepping_drive(one, clock)))
    await plant.forward(seconds=1)
    for turn in range(3):
        with suppress(CommandRejected):
            await plant.ask(Jog(f"press{turn}", Axis.AZIMUTH, 1, JogSpeed.FAST))
        await plant.forward(seconds=0.4)
    fault = plant.tracker().fault
    await plant.ask(Stop())
    await plant.forward(seconds=1)
    assert plant.site.alive
    loop = plant.site.model.tracker("T1")
    assert loop.broken is None
    assert (await loop.stop_drive()) is True
    is_commanded = row["register"].endswith("acceleration") and "becomes zero" not in row["why"]
    assert (fault is not None) == is_commanded, "a jog writes the ramp, and only a part of the other numbers"
    if fault is None:
        return
    assert fault.code == "command_refused"
    assert f"does not fit into register {row['register']}" in fault.message
    assert fault.message.endswith(f"Change {row['change']} of the azimuth axis.")
    await plant.ask(ResetFault())
    await plant.forward(seconds=2)
    assert plant.tracker().activity is ActivityName.HOLDING


def kept_plant(row: dict[str, str], clock: VirtualClock, make: Callable[[TrackerConfig], Drive]) -> Plant:
    """Return a site whose tracker was stored with the settings of the row."""
    state = TrackerState(config_of(row), TrackerMemory())
    return Plant(clock, Site(clock, make, SiteState(), (state,), options=SiteOptions()), {})


async def test_what_is_stored_and_does_not_fit_refuses_no_other_setting(tmp_path: Path, begun: Begun) -> None:
    """A kept tracker is still renamed and protected; its speeds and its drive are saved once they fit."""
    clock = VirtualClock(SUMMER_NOON)
    plant = await begun(kept_plant(MISFITS[0], clock, factory_of(MISFITS[0], tmp_path, clock).make))
    named = replace(plant.site.model.tracker("T1").config, name="North")
    await plant.ask(ConfigureTracker(named))
    assert plant.site.model.tracker("T1").config == named
    narrowed = replace(named, azimuth=replace(named.azimuth, maximum_deg=350.0))
    with pytest.raises(ValueError, match="the acceleration or the gear ratio of the azimuth axis"):
        await plant.ask(ConfigureTracker(narrowed))
    geared = replace(named.drive, azimuth=replace(named.drive.azimuth, gear_ratio=60.0))
    await plant.ask(ConfigureTracker(replace(narrowed, drive=geared)))
    assert plant.site.model.tracker("T1").config.drive == geared


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
