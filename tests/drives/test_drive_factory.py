"""The watchdog of a simulated drive, and what the commands around lines take and refuse."""

from datetime import timedelta
from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.base.clock import VirtualClock
from app.cli import cli
from app.machine.drive_factory import DriveFactory
from app.simulation.faults import Fault, FaultKind
from app.simulation.servers.sim_server import parse_address, parse_fault
from app.tracker.settings.axes import Axis
from tests.drives.rigs import CONFIG, START


def test_addresses_and_faults_are_read_as_a_person_writes_them() -> None:
    assert parse_address("[::1]:502") == ("::1", 502)
    for text in ("", "5020", "host:x", "host:99999", ":5020"):
        with pytest.raises(ValueError, match="HOST:PORT"):
            parse_address(text)
    assert parse_fault("stall:elevation") == Fault(FaultKind.STALL, Axis.ELEVATION)
    assert parse_fault("encoder_jump:both:-3.5") == Fault(FaultKind.ENCODER_JUMP, None, -3.5)
    for text in ("", "nonsense", "stall:left", "slip:azimuth:fast"):
        with pytest.raises(ValueError, match="is no fault"):
            parse_fault(text)


@pytest.mark.parametrize(("tick_ms", "watchdog_s"), [(100, 0.5), (1000, 2.5)])
def test_the_watchdog_of_a_simulated_drive_outlasts_a_late_tick(tick_ms: int, watchdog_s: float) -> None:
    """With 0.5 s at a tick a second every drive stopped on its way to shelter."""
    factory = DriveFactory(VirtualClock(START), tick=timedelta(milliseconds=tick_ms))
    assert factory.make(CONFIG).capabilities.watchdog_s == watchdog_s


def refused(*words: str) -> Exception:
    """Return why a command did nothing."""
    result = CliRunner().invoke(cli, words)
    assert isinstance(result.exception, ValueError | OSError), result.output
    return result.exception


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("near", "127.0.0.1:5020"), "choose --frames rtu"),
        (("127.0.0.1:5021", "127.0.0.1:5020", "--script", "explode"), "'explode' is no fault"),
        (("127.0.0.1:5021", "127.0.0.1:5020", "--script", "checksum"), "not possible with tcp frames"),
        ((":5021", "127.0.0.1:5020"), "Write it as HOST:PORT"),
    ],
)
def test_a_proxy_that_cannot_work_is_refused_with_what_to_do(words: tuple[str, str], why: str) -> None:
    assert why in str(refused("fault-proxy", *words))


def test_a_simulated_drive_takes_no_file_for_a_line_and_is_no_broadcast(tmp_path: Path) -> None:
    name = tmp_path / "notes"
    name.write_text("mine")
    assert "not another file or device" in str(refused("drive-sim", "--rtu", str(name)))
    assert name.read_text() == "mine"
    assert "between 1 and 247" in str(refused("drive-sim", "--rtu", "line", "--unit", "0"))
