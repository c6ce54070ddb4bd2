"""A profile of one's own for drives whose communication watchdog somebody has switched on."""

from pathlib import Path

import pytest

from app.drives.profile import PROFILES
from app.tracker.values.motion import DriveCommand, Velocity
from tests.drives.device_rigs import BENCHES, Bench, device_rig
from tests.drives.rigs import Trait

WATCHDOG = """
[watchdog]
timeout_ms = 500
action = "The drive ramps down and raises an alarm."
"""


def with_watchdog(name: str, folder: Path) -> Bench:
    """Return a bench with the shipped profile and a watchdog that every request feeds."""
    (folder / "profiles").mkdir()
    text = (PROFILES / f"{name}.toml").read_text(encoding="utf-8").replace(f'name = "{name}"', 'name = "own"')
    (folder / "profiles" / "own.toml").write_text(text + WATCHDOG, encoding="utf-8")
    known = BENCHES[name]
    return Bench("own", known.gear_ratio, known.traits - {Trait.STEPS}, known.speed_step_dps)


@pytest.mark.parametrize("name", ["kinco-cia402", "leadshine-rs", "oriental-az"])
async def test_with_a_watchdog_hand_motion_is_one_command_until_the_next(name: str, tmp_path: Path) -> None:
    async with device_rig(with_watchdog(name, tmp_path), tmp_path) as rig:
        can = rig.drive.capabilities
        assert (can.watchdog_s, can.watchdog_action) == (0.5, "The drive ramps down and raises an alarm.")
        before = await rig.forward(1.5, DriveCommand(Velocity(-3.0), Velocity(2.0)))
        rig.idle(2.0)
        feedback = await rig.drive.read()
        way_deg = feedback.azimuth.position_deg - before.azimuth.position_deg
        assert way_deg == pytest.approx(-6.0, abs=0.02), "no step ends it: the device's watchdog would"
        assert feedback.elevation.velocity_dps == pytest.approx(2.0, abs=rig.speed_step_dps)
        halted = await rig.forward(1.0)
        assert not halted.azimuth.moving
        assert not halted.elevation.moving
