"""Any bytes at all: the server always answers properly, the master never takes a wrong reply."""

from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.base.clock import VirtualClock
from app.drives.profile import load_profile
from app.modbus.reply import BadReply, is_complete, wanted_read, wanted_write
from app.modbus.server import answer
from app.simulation.sim_plc import SimulatedPlc
from app.simulation.simulated import SimulatedDrive
from tests.drives.rigs import CONFIG, START
from tests.drives.scripted_server import right

READ = bytes((0, 9, 0, 0, 0, 6, 1, 3, 0, 10, 0, 4))
WRITE = bytes((0, 9, 0, 0, 0, 6, 1, 6, 0, 10, 0, 4))
WRITE_MANY = bytes((0, 9, 0, 0, 0, 11, 1, 16, 0, 10, 0, 2, 4, 0, 1, 0, 2))
REPLIES = {
    "read": (right(READ), wanted_read(1, 4), 9),
    "write": (right(WRITE), wanted_write(1, 10, (4,)), 12),
    "write of several": (right(WRITE_MANY), wanted_write(1, 10, (1, 2)), 12),
}


@given(st.lists(st.binary(min_size=1, max_size=260), min_size=1, max_size=5))
def test_the_server_answers_whatever_comes(requests: list[bytes]) -> None:
    clock = VirtualClock(START)
    plc = SimulatedPlc(load_profile("simulated-plc"), SimulatedDrive(CONFIG, clock), clock)
    for request in requests:
        reply = answer(plc, request)
        assert reply[0] in (request[0], request[0] | 0x80)
        if reply[0] != request[0]:
            assert reply[1] in (1, 2, 3)


@pytest.mark.parametrize("name", REPLIES)
@given(data=st.data())
def test_one_wrong_byte_is_never_taken_for_the_reply(name: str, data: st.DataObject) -> None:
    reply, wanted, checked = REPLIES[name]
    place = data.draw(st.integers(0, checked - 1))
    value = data.draw(st.integers(0, 255).filter(lambda byte: byte != reply[place]))
    damaged = reply[:place] + bytes((value,)) + reply[place + 1 :]
    with suppress(BadReply):
        assert not is_complete(damaged, wanted, 9)


def test_the_right_reply_is_complete_with_its_last_byte_only() -> None:
    for reply, wanted, _ in REPLIES.values():
        complete = [is_complete(reply[:end], wanted, 9) for end in range(len(reply) + 1)]
        assert complete == [False] * len(reply) + [True]


@given(st.binary(max_size=300))
def test_random_bytes_are_never_a_reply(noise: bytes) -> None:
    reply, wanted, _ = REPLIES["write of several"]
    try:
        assert is_complete(noise, wanted, 9) is (noise == reply)
    except BadReply:
        assert noise != reply
