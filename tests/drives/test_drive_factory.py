"""Which drive a tracker's settings make, and the words of `heliopanel drive-sim`."""

from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.drives.profile import ProfileError
from app.machine.drive_factory import DriveFactory
from app.simulation.faults import Fault, FaultKind
from app.simulation.servers.sim_server import parse_address, parse_fault
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, DriveKind
from tests.drives.rigs import CONFIG, START


def test_the_factory_makes_a_simulated_drive_with_its_memory(tmp_path: Path) -> None:
    clock = VirtualClock(START)
    assert isinstance(
        DriveFactory(clock, tmp_path).make(replace(CONFIG, tracker_id="../T 1")), SimulatedDrive
    )
    assert [path.name for path in (tmp_path / "drives").iterdir()] == ["positions"]
    assert isinstance(DriveFactory(clock).make(CONFIG), SimulatedDrive)


def test_the_factory_refuses_an_unknown_profile() -> None:
    config = replace(CONFIG, drive=DriveConfig(DriveKind.MODBUS_TCP, profile="nonsense"))
    with pytest.raises(ProfileError, match="no drive profile"):
        DriveFactory(VirtualClock(START)).make(config)


def test_addresses_are_host_and_port() -> None:
    assert parse_address("127.0.0.1:5020") == ("127.0.0.1", 5020)
    assert parse_address("[::1]:502") == ("::1", 502)


@pytest.mark.parametrize("text", ["", "5020", "host:", "host:x", "host:99999", ":5020"])
def test_a_wrong_address_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="HOST:PORT"):
        parse_address(text)


def test_faults_are_kind_axis_and_amount() -> None:
    assert parse_fault("silence") == Fault(FaultKind.SILENCE)
    assert parse_fault("stall:elevation") == Fault(FaultKind.STALL, Axis.ELEVATION)
    assert parse_fault("encoder_jump:both:-3.5") == Fault(FaultKind.ENCODER_JUMP, None, -3.5)


@pytest.mark.parametrize("text", ["", "nonsense", "stall:left", "slip:azimuth:fast"])
def test_a_wrong_fault_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="is no fault"):
        parse_fault(text)


@pytest.mark.parametrize(("tick_ms", "watchdog_s"), [(0, 0.5), (100, 0.5), (1000, 2.5)])
def test_the_watchdog_of_a_simulated_drive_outlasts_a_late_tick(tick_ms: int, watchdog_s: float) -> None:
    """With 0.5 s at a tick a second every drive stopped on its way to shelter."""
    factory = DriveFactory(VirtualClock(START), tick=timedelta(milliseconds=tick_ms))
    assert factory.make(CONFIG).capabilities.watchdog_s == watchdog_s
