"""The commands around profiles, as a person types them."""

import asyncio
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.base.clock import SystemClock
from app.cli.profiles import drive
from app.drives.profile import PROFILES, load_profile
from app.modbus.server import ModbusServer
from app.simulation.devices.shelf import devices
from app.simulation.simulated import SimulatedDrive
from tests.drives.rigs import CONFIG


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Two simulated Leadshine drives on a socket, served from a loop of their own."""
    loop = asyncio.new_event_loop()
    serving = threading.Thread(target=loop.run_forever)
    serving.start()

    async def start() -> tuple[ModbusServer, int]:
        machine = SimulatedDrive(CONFIG, SystemClock(), watchdog=None)
        found = devices(load_profile("leadshine-rs"), machine, SystemClock(), 1)
        server = ModbusServer(found[1], 1, others=found)
        return server, await server.start("127.0.0.1", 0)

    server, port = asyncio.run_coroutine_threadsafe(start(), loop).result(10.0)
    yield f"127.0.0.1:{port}"
    asyncio.run_coroutine_threadsafe(server.close(), loop).result(10.0)
    loop.call_soon_threadsafe(loop.stop)
    serving.join()
    loop.close()


def run(*arguments: str) -> tuple[int, str]:
    """Return the exit code, and what is printed: the sentence of an error comes from the program's main."""
    result = CliRunner().invoke(drive, arguments)
    return result.exit_code, f"{result.output}{result.exception or ''}"


def test_a_right_profile_is_called_right_and_a_wrong_one_names_its_line(tmp_path: Path) -> None:
    assert "Not verified on a device: trigger, inputs." in run("profiles")[1]
    said = run("check", "kinco-cia402")[1]
    assert "13 registers, no watchdog, switches lower_limit, upper_limit, origin." in said
    assert "no limit switches" in run("check", "oriental-az")[1]
    own = tmp_path / "own.toml"
    text = (PROFILES / "kinco-cia402.toml").read_text(encoding="utf-8")
    own.write_text(text.replace('"uint16", access', '"uint15", access', 1), encoding="utf-8")
    code, said = run("check", str(own))
    assert code == 1
    assert "own.toml, line 2" in said
    assert "must be one of uint16" in said


def test_a_frame_can_be_held_against_the_manual() -> None:
    assert run("frame", "kinco-cia402", "controlword", "15")[1].strip() == "01 06 31 00 00 0F C7 32"
    assert "has no register 'nonsense'" in run("frame", "kinco-cia402", "nonsense", "1")[1]


def test_a_probe_shows_both_axes_and_marks_what_is_unverified(address: str) -> None:
    code, text = run("probe", "--profile", "leadshine-rs", "--tcp", address)
    assert code == 0, text
    assert all(one in text for one in ("unit 1", "unit 2", "unverified trigger", "verified   status"))


def test_a_scan_names_the_units_that_answer(address: str) -> None:
    code, text = run("scan", "--tcp", address, "--last", "3", "--address", "1")
    assert code == 0, text
    assert [line.split(":")[0] for line in text.splitlines()] == ["unit 1", "unit 2"]
    code, text = run("scan", "--tcp", address, "--first", "9", "--last", "9")
    assert (code, "No unit from 9 to 9 answers" in text) == (1, True)


@pytest.mark.parametrize("options", [(), ("--tcp", "127.0.0.1:1", "--rtu", "/dev/null")])
def test_exactly_one_way_to_the_device_is_taken(options: tuple[str, ...]) -> None:
    assert "Give one of --tcp" in run("probe", "--profile", "leadshine-rs", *options)[1]


def test_what_is_recorded_can_be_replayed_behind_its_gear(address: str, tmp_path: Path) -> None:
    trace = tmp_path / "bus.jsonl"
    code, text = run("record", str(trace), "--profile", "leadshine-rs", "--tcp", address, "--seconds", "0.2")
    assert code == 0, text
    for gear, angles in (
        ("1", "azimuth 102.384 deg  elevation 36.612 deg"),
        ("2", "azimuth 51.192 deg  elevation 18.306 deg"),
    ):
        code, text = run("replay", str(trace), "--profile", "leadshine-rs", "--gear", gear)
        assert code == 0, text
        assert angles in text, "whole steps"
        assert "at rest" in text
    code, said = run("replay", str(tmp_path / "none.jsonl"), "--profile", "leadshine-rs")
    assert (code, "does not exist" in said) == (2, True)


@pytest.mark.parametrize(
    ("profile", "gear", "says"),
    [
        ("leadshine-rs", "1", "1000000 does not fit into register path_acceleration"),
        ("leadshine-rs", "60", None),
        ("kinco-cia402", "300000", "does not fit into register target_position"),
        ("simulated-plc", "1", None),
    ],
)
def test_a_profile_is_checked_with_a_gear(profile: str, gear: str, says: str | None) -> None:
    code, text = run("check", profile, "--gear", gear)
    assert (code == 0) is (says is None), text
    assert says is None or says in text
