"""Every fault on every wire: no wrong value is believed, the next read is right, and a stop goes at once."""

import asyncio

import pytest

from app.drives.connections.buses import Buses
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveError, DriveSilent
from app.modbus.wire_faults import ONLY, Framing, WireFault, parse_script
from app.tracker.settings.config import DriveConfig, DriveKind, SerialConfig
from tests.drives.proxied import BENCHES, STOP_REGISTER, TIMING, Bench
from tests.patient_loop import LoopClock

RECOVERED_WITHIN_S = {"tcp": 0.3, "rtu": 1.0, "rtu-over-tcp": 1.0}
STOP_WITHIN_S = 0.05
"""A quarter of the time that a poll without an answer holds the line."""
LATE = ("delay=250", "delay=450", "delay=700")


def faults(wire: str) -> list[str]:
    framing = Framing.TCP if wire == "tcp" else Framing.RTU
    plain = [fault for fault in WireFault if ONLY.get(fault, framing) is framing]
    if wire == "rtu":
        plain = [fault for fault in plain if fault not in (WireFault.RESET, WireFault.CLOSE)]
    return [*(fault for fault in plain if fault is not WireFault.DELAY), *LATE]


CASES = [(wire, fault) for wire in BENCHES for fault in faults(wire) if fault != WireFault.CLEAR]


async def one_read(bench: Bench, device: BusUnit, address: int) -> bool:
    """Read a block; return whether it was read. A wrong value fails the test."""
    try:
        found = await device.read(address, 4, what="four registers")
    except DriveError:
        return False
    assert found == bench.right(device.unit, address, 4), "a wrong value was believed"
    return True


async def recovery(bench: Bench, devices: list[BusUnit], fault: str) -> float:
    """Play a fault once and return how long it took from the first read until one was right."""
    bench.proxy.play(f"{fault} 1")
    loop = asyncio.get_running_loop()
    began_s = loop.time()
    turn = 0
    while not await one_read(bench, devices[turn % 2], 10 + turn):
        turn += 1
        assert turn < 6
    return loop.time() - began_s


@pytest.mark.parametrize(("wire", "fault"), CASES)
async def test_no_wrong_value_is_believed_and_the_next_read_is_right(wire: str, fault: str) -> None:
    async with BENCHES[wire]() as bench:
        devices = [bench.buses.unit(bench.config, unit, TIMING) for unit in bench.devices]
        for device in devices:
            assert await one_read(bench, device, 10)
        assert await recovery(bench, devices, fault) < RECOVERED_WITHIN_S[wire]
        again = [await one_read(bench, devices[place % 2], 20 + place) for place in range(8)]
        assert again == [True] * 8, "the bus is in step again"
        await asyncio.gather(*(device.stop(STOP_REGISTER, [1], what="stop") for device in devices))
        assert [one.written for one in bench.devices.values()] == [[(STOP_REGISTER, [1])]] * 2
        for device in devices:
            await device.close()


@pytest.mark.parametrize(
    ("wire", "fault"), [(w, f) for w in BENCHES for f in ("clear", "drop", "black-hole")]
)
async def test_a_stop_goes_at_once_while_polls_are_in_flight(wire: str, fault: str) -> None:
    async with BENCHES[wire]() as bench:
        device, other = (bench.buses.unit(bench.config, unit, TIMING) for unit in bench.devices)
        assert await one_read(bench, device, 10)
        assert await one_read(bench, other, 10)
        bench.proxy.play(fault)
        polls = [asyncio.create_task(one_read(bench, one, 30)) for one in (device, other) * 3]
        took_s = []
        for _ in range(3):
            await asyncio.sleep(0.01)
            asked_s, before = asyncio.get_running_loop().time(), len(bench.proxy.stopped_at_s)
            stop = asyncio.create_task(device.stop(STOP_REGISTER, [1], what="stop"))
            await asyncio.wait([stop], timeout=0.15)
            assert len(bench.proxy.stopped_at_s) > before, "every stop is sent"
            took_s.append(bench.proxy.stopped_at_s[before] - asked_s)
            stop.cancel()
            await asyncio.gather(stop, return_exceptions=True)
        assert max(took_s) < STOP_WITHIN_S
        for poll in polls:
            poll.cancel()
        await asyncio.gather(*polls, return_exceptions=True)
        await device.close()
        await other.close()


def test_a_script_says_when_what_happens_and_what_cannot_be_played_is_said() -> None:
    script = parse_script("after 2 frames: drop 2; delay=50 1", Framing.TCP)
    played = [script.next() for _ in range(6)]
    assert [step.fault for step in played] == ["clear", "clear", "drop", "drop", "delay", "clear"]
    assert played[4].amount == 50.0
    stays = parse_script("noise", Framing.RTU)
    assert {stays.next().fault for _ in range(9)} == {"noise"}
    for text in ("nonsense", "drop x", "after: drop", "wrong-transaction"):
        with pytest.raises(ValueError, match=r"is no fault|not possible"):
            parse_script(text, Framing.RTU)


async def test_a_line_in_use_with_other_settings_is_refused() -> None:
    buses = Buses(LoopClock())
    first, second = (
        buses.unit(DriveConfig(DriveKind.MODBUS_RTU, serial=SerialConfig("/dev/none", rate)), unit, TIMING)
        for unit, rate in ((1, 9600), (2, 19200))
    )
    with pytest.raises(DriveSilent):
        await first.read(0, 1, what="a word")
    with pytest.raises(DriveError, match="other settings"):
        await second.read(0, 1, what="a word")
    await first.close()
    await second.close()
