"""The firmware that is flashed, run cycle by cycle: registers, motion, switches, and what stops it."""

import random
from collections.abc import Iterator
from itertools import pairwise
from struct import pack, unpack
from tomllib import loads

import pytest

from app.modbus.rtu_frame import sealed
from tests.amount import amount
from tests.controllers.avr_board import (
    EMERGENCY,
    HALT,
    HOME,
    HZ,
    LOCAL,
    POSITION,
    RESET_FAULT,
    ROOT,
    SET_HOME_AZIMUTH,
    SET_HOME_ELEVATION,
    STEPS_PER_DEG,
    UPPER,
    VELOCITY,
    Board,
    powered,
)

ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
LOWER_OF_ELEVATION, UPPER_OF_ELEVATION = 3, 4


@pytest.fixture
def board() -> Iterator[Board]:
    with powered() as board:
        yield board


def refused(reply: bytes) -> int | None:
    return reply[1] if reply[0] & 0x80 else None


def test_the_whole_map_is_answered_and_nothing_else(board: Board) -> None:
    profile = loads((ROOT / "app/drives/profiles/simulated-plc.toml").read_text(encoding="utf-8"))
    known, writable = set(range(40)), set()
    for register in profile["registers"].values():
        width = 2 if register["type"].endswith("32") else 1
        addresses = set(range(register["address"], register["address"] + width))
        known |= addresses
        writable |= addresses if register.get("access") == "read-write" else set()
    for address in (*range(60), 900, 65535):
        for function in (3, 4):
            reply = board.ask(pack(">BHH", function, address, 1))
            assert refused(reply) == (None if address in known else ILLEGAL_ADDRESS), address
        reply = board.ask(pack(">BHH", 6, address, 0))
        assert refused(reply) == (None if address in writable else ILLEGAL_ADDRESS), address
    assert refused(board.ask(pack(">BHH", 3, 39, 2))) == ILLEGAL_ADDRESS
    assert refused(board.ask(pack(">BHH", 3, 0, 126))) == ILLEGAL_VALUE
    assert refused(board.ask(pack(">BHH", 7, 0, 1))) == ILLEGAL_FUNCTION
    assert refused(board.write(19, 0, 1)) == ILLEGAL_ADDRESS
    words = board.status().words[21:33]
    for address, without_meaning in ((21, 3), (32, 5)):
        assert refused(board.write(address, without_meaning)) == ILLEGAL_VALUE
    assert board.status().words[21:33] == words


def test_the_clock_is_set_by_one_frame_with_a_date(board: Board) -> None:
    assert refused(board.write(50, 2028, 2, 28, 23, 59, 59)) is None
    board.run(1.0)
    reply = board.ask(pack(">BHH", 3, 50, 6))
    assert unpack(">6H", reply[2:])[:5] == (2028, 2, 29, 0, 0)
    assert refused(board.write(50, 2027, 2, 29, 0, 0, 0)) == ILLEGAL_VALUE
    assert refused(board.write(50, 1999)) is None
    assert unpack(">H", board.ask(pack(">BHH", 3, 50, 1))[2:]) == (2028,)


def test_discrete_inputs_are_status_and_switches_and_coil_0_stops(board: Board) -> None:
    board.hold(UPPER, 1)
    board.drive(1.0, (VELOCITY, -3000, 0))
    assert board.ask(pack(">BHH", 2, 0, 32)) == bytes((2, 4, 1, 0, 2, 0))
    assert board.ask(pack(">BHH", 2, 16, 2)) == bytes((2, 1, 2))
    assert refused(board.ask(pack(">BHH", 2, 16, 17))) == ILLEGAL_ADDRESS
    assert board.ask(pack(">BHH", 1, 0, 1)) == bytes((1, 1, 0))
    board.ask(pack(">BHH", 5, 0, 0xFF00))
    board.run(0.55)
    assert board.status().velocities_mdps == (0, 0)
    board.drive(1.0, (VELOCITY, -3000, 0))
    board.ask(pack(">BHHBB", 15, 0, 1, 1, 1))
    board.run(0.55)
    assert board.status().velocities_mdps == (0, 0)
    assert refused(board.ask(pack(">BHH", 5, 1, 0xFF00))) == ILLEGAL_ADDRESS
    assert refused(board.ask(pack(">BHH", 5, 0, 1))) == ILLEGAL_VALUE


def test_a_damaged_frame_and_another_unit_are_not_answered(board: Board) -> None:
    frame = sealed(bytes((1,)) + pack(">BHH", 3, 0, 40))
    for bit in range(8 * len(frame)):
        damaged = bytearray(frame)
        damaged[bit // 8] ^= 1 << bit % 8
        assert board.ask_raw(bytes(damaged)) == b"", bit
    for unit in (0, 2, 255):
        assert board.ask_raw(sealed(bytes((unit,)) + frame[1:-2])) == b""
    assert board.ask_raw(bytes(300)) == b""
    assert board.ask_raw(frame)[:3] == bytes((1, 3, 80))


@pytest.mark.parametrize(("axis", "sign"), [(0, 1), (1, -1)])
def test_a_ramp_has_its_direction_acceleration_and_scale(board: Board, axis: int, sign: int) -> None:
    start = board.counted()[axis].position
    commands = [(HALT, 0, 0), (HALT, 0, 0)]
    commands[axis] = (VELOCITY, sign * 2000, 0)
    board.mark()
    status = board.drive(1.0, commands[0], commands[1])
    assert status.velocities_mdps[axis] == sign * 2000
    assert status.moving == (axis == 0, axis == 1)
    board.drive(0.6)
    counted = board.counted()
    assert board.status().positions_mdeg[axis] - (102_400, 36_600)[axis] == 5 * (
        counted[axis].position - start
    )
    assert (counted[axis].position - start) * sign == counted[axis].pulses > 0
    assert counted[1 - axis].pulses == 0
    edges = board.edges(axis)
    way_steps = 2.0 * 2.0 / (2 * 6.0) * STEPS_PER_DEG
    ramp_s = (edges[round(way_steps)] - edges[10]) / HZ
    assert ramp_s == pytest.approx(2.0 / 6.0 - (2 * 10.5 / STEPS_PER_DEG / 6.0) ** 0.5, abs=0.008)


def test_steps_at_a_constant_speed_are_even(board: Board) -> None:
    board.drive(2.0, (VELOCITY, 6000, 0), (VELOCITY, 4000, 0))
    board.mark()
    board.drive(1.0, (VELOCITY, 6000, 0), (VELOCITY, 4000, 0))
    for counted, speed_dps in zip(board.counted(), (6, 4), strict=True):
        interval = HZ / (speed_dps * STEPS_PER_DEG)
        assert interval - 16 <= counted.least <= counted.most <= interval + 16


def test_a_move_ends_at_its_target_also_beyond_a_new_one(board: Board) -> None:
    board.drive(1.0, (POSITION, 140_000, 6000), (POSITION, 30_000, 4000))
    status = board.until_rest((POSITION, 103_400, 6000), (POSITION, 36_000, 2000))
    assert status.positions_mdeg == (103_400, 36_000)
    assert [counted.position for counted in board.counted()] == [13_400 // 5, 6_000 // 5]


def test_a_stop_begins_within_20_ms_of_its_frame_and_its_command_is_ignored(board: Board) -> None:
    board.drive(2.0, (VELOCITY, 6000, 0))
    board.mark()
    words = (9999, VELOCITY, 0, 6000, 0, 0, HALT, 0, 0, 0, 0, 0, 0, 1)
    board.say("put " + sealed(bytes((1,)) + pack(">BHHB14H", 16, 20, 14, 28, *words)).hex())
    sent = board.cycle
    board.run(1.2)
    edges = board.edges(0)
    even = HZ / (6 * STEPS_PER_DEG)
    slower = next(later for earlier, later in pairwise(edges) if later - earlier > even * 1.01)
    assert 0.0 < (slower - sent) / HZ < 0.020
    assert edges[-1] - sent == pytest.approx(HZ, rel=0.05), "6 deg/s at 6 deg/s2"
    assert board.status().words[21] == HALT


def test_without_a_new_keep_alive_value_both_axes_ramp_down(board: Board) -> None:
    before = board.drive(1.0, (VELOCITY, 3000, 0), (VELOCITY, 2000, 0))
    board.command((VELOCITY, 3000, 0), (VELOCITY, 2000, 0))
    board.mark()
    sent = board.cycle
    for _ in range(20):
        board.run(0.1)
        status = board.status()
    assert status.tripped
    assert status.moving == (False, False)
    assert (board.edges(0)[-1] - sent) / HZ == pytest.approx(0.5 + 0.5, abs=0.03)
    assert status.positions_mdeg[0] - before.positions_mdeg[0] == pytest.approx(2250, abs=150)
    assert not board.drive(0.1).tripped
    assert board.drive(1.0, (VELOCITY, 3000, 0)).velocities_mdps == (3000, 0)


def test_a_limit_switch_stops_its_axis_in_its_direction_alone(board: Board) -> None:
    for axis, (velocity, limit) in enumerate(((-6000, -5.0), (4000, 95.0))):
        board.world(axis, limit - velocity / 1000, -5.0, 365.0 if axis == 0 else 95.0, 0.5)
        commands = [(HALT, 0, 0), (HALT, 0, 0)]
        commands[axis] = (VELOCITY, velocity, 0)
        status = board.until_rest(commands[0], commands[1])
        beyond = abs(board.counted()[axis].position / STEPS_PER_DEG - limit)
        assert beyond < 0.4
        assert status.words[6] >> (3 * axis) & 0b11 == (1 if velocity < 0 else 2)
        commands[axis] = (VELOCITY, -velocity, 0)
        back = board.drive(1.0, commands[0], commands[1])
        assert back.velocities_mdps[axis] == -velocity
        assert back.words[6] & 0b11011 == 0


def test_both_limit_switches_of_an_axis_at_once_are_a_fault(board: Board) -> None:
    board.hold(LOWER_OF_ELEVATION, 1)
    board.hold(UPPER_OF_ELEVATION, 1)
    status = board.drive(1.0, (VELOCITY, 3000, 0))
    assert (status.fault, status.velocities_mdps, board.counted()[0].pulses) == (2, (0, 0), 0)
    board.hold(UPPER_OF_ELEVATION, None)
    board.hold(LOWER_OF_ELEVATION, None)
    assert board.drive(0.5, request=(1, RESET_FAULT)).fault == 0
    assert board.drive(1.0, (VELOCITY, 3000, 0)).velocities_mdps == (3000, 0)


def test_an_emergency_stop_ends_all_pulses_and_is_a_fault_until_it_is_reset(board: Board) -> None:
    board.drive(0.1, request=(1, SET_HOME_AZIMUTH))
    board.drive(1.0, (VELOCITY, 3000, 0), (VELOCITY, 2000, 0))
    board.hold(EMERGENCY, 1)
    board.run(0.005)
    board.mark()
    status = board.drive(0.5, (VELOCITY, 3000, 0), (VELOCITY, 2000, 0))
    assert (status.fault, status.moving, status.homed) == (1, (False, False), (False, False))
    assert board.edges(0) == board.edges(1) == []
    assert board.drive(0.3, request=(2, RESET_FAULT)).fault == 1, "it is still pressed"
    board.hold(EMERGENCY, 0)
    assert board.drive(0.3).fault == 1
    status = board.drive(0.3, request=(3, HOME))
    assert (status.failed, status.homing) == (True, False)
    assert board.drive(0.3, request=(4, RESET_FAULT)).fault == 0
    assert board.drive(1.0, (VELOCITY, 3000, 0)).velocities_mdps == (3000, 0)


def test_the_local_switch_bars_motion(board: Board) -> None:
    board.hold(LOCAL, 0)
    status = board.drive(0.5, (VELOCITY, 3000, 0))
    assert (status.local, board.counted()[0].pulses) == (True, 0)


def test_brakes_are_released_in_motion_and_engage_at_rest(board: Board) -> None:
    assert board.outputs() & 0b1100 == 0
    board.drive(0.5, (VELOCITY, 3000, 0))
    assert board.outputs() & 0b1100 == 0b0100
    board.until_rest()
    board.run(0.6)
    assert board.outputs() & 0b1100 == 0


@pytest.mark.parametrize("start_deg", [0.3, -3.0])
def test_homing_finds_the_middle_of_the_home_switches(board: Board, start_deg: float) -> None:
    board.world(0, start_deg, -5.0, 365.0, 0.5)
    assert board.drive(0.5, request=(5, HOME)).homing
    status = board.until_rest(request=(5, HOME))
    assert (status.words[16], status.failed, status.homed) == (5, False, (True, True))
    assert status.positions_mdeg == (0, 0)
    assert max(abs(counted.position) for counted in board.counted()) <= 1
    assert status.words[6] == 0b100100


def test_a_stop_ends_homing_and_a_home_position_is_lost_with_the_power(board: Board) -> None:
    board.drive(0.5, request=(5, HOME))
    board.write(33, 1)
    status = board.status()
    assert (status.homing, status.failed, status.words[16]) == (False, True, 5)
    board.until_rest()
    status = board.drive(0.2, request=(6, SET_HOME_ELEVATION))
    assert (status.homed, status.positions_mdeg[1]) == ((False, True), 0)
    board.reset()
    status = board.status()
    assert (status.homed, status.words[4]) == ((False, False), 2), "another life"


@pytest.mark.timeout(amount(120, 3600))
def test_pulses_sent_are_the_position_told(board: Board) -> None:
    """Random motion of both axes on a line that talks all the time: no pulse is lost, none is extra."""
    chance = random.Random(7)
    ends = (board.counted()[0].position, board.counted()[1].position)
    board.world(0, 12.4, -1e4, 1e4, -1)
    board.world(1, 6.6, -1e4, 1e4, -1)
    pulses = 0
    while pulses < amount(20_000, 10_000_000):
        azimuth = (VELOCITY, chance.choice((-6000, 6000, 1234)), 0)
        elevation = (POSITION, chance.randrange(-720_000, 720_000), chance.choice((4000, 3999, 17)))
        board.drive(chance.uniform(0.2, 6.0), azimuth, elevation)
        pulses = sum(counted.pulses for counted in board.counted())
    told = board.until_rest().positions_mdeg
    counted = board.counted()
    assert told[0] - 102_400 == 5 * (counted[0].position - ends[0])
    assert told[1] - 36_600 == 5 * (counted[1].position - ends[1])
