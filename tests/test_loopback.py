"""Tests and fuzzers stay on this computer: what they call elsewhere never even reaches Linux."""

import asyncio
import os
import socket
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
import uvloop

from tools.alone import UNSHARE, may_be_alone

ELSEWHERE = ("192.0.2.1", 9)
"""An address of TEST-NET-1, which no network has."""
TRIES = """
import asyncio, socket, uvloop
there = ("192.0.2.1", 9)
def datagram(): return socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
def stream():
    made = socket.socket()
    made.setblocking(False)
    return made
tries = [
    lambda: stream().connect(there),
    lambda: stream().connect_ex(there),
    lambda: datagram().connect(there),
    lambda: datagram().sendto(b"x", there),
    lambda: datagram().sendmsg([b"x"], [], 0, there),
    lambda: asyncio.run(asyncio.wait_for(asyncio.open_connection(*there), 1)),
    lambda: uvloop.run(asyncio.wait_for(asyncio.open_connection(*there), 1)),
]
for attempt in tries:
    try:
        attempt()
    except (OSError, TimeoutError) as refused:
        print(type(refused).__name__)
"""
NETWORK_CALLS = "connect,sendto,sendmsg,sendmmsg"
UNREACHABLE = f"--inject={NETWORK_CALLS}:error=ENETUNREACH"


def traced(
    tmp_path: Path, before: Sequence[str] = (), more: Sequence[str] = (), *, guarded: bool
) -> tuple[list[str], int]:
    """Return how each try of another process ended, and how many calls to there Linux got."""
    log = tmp_path / "calls"
    environment = os.environ if guarded else {**os.environ, "PYTHONPATH": ""}
    trace = ("strace", "-f", f"--trace={NETWORK_CALLS}", "-o", str(log))
    command = [*before, *trace, *more, sys.executable, "-c", TRIES]
    told = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return told.stdout.split(), log.read_text().count(f'"{ELSEWHERE[0]}"')


def test_linux_never_hears_of_a_call_to_another_computer(tmp_path: Path) -> None:
    ends, calls = traced(tmp_path, guarded=True)
    assert ends == ["CalledElsewhere"] * 7
    assert calls == 0


def test_in_a_network_of_its_own_linux_refuses_what_the_guard_would_not(tmp_path: Path) -> None:
    """Without the guard the same tries reach Linux: the proof above would see them.

    Where a user may have no network namespace, strace answers in the place of Linux, so that none gets out.
    """
    alone = may_be_alone()
    ends, calls = traced(
        tmp_path, before=UNSHARE if alone else (), more=() if alone else (UNREACHABLE,), guarded=False
    )
    assert ends == ["OSError"] * 6, "connect_ex tells it without an exception"
    assert calls >= 7


def on_socket(ask: Callable[[socket.socket], object], **kind: int) -> None:
    with socket.socket(**kind) as made:
        ask(made)


@pytest.mark.parametrize(
    "ask",
    [
        lambda: socket.getaddrinfo("heliopanel.example", 80),
        lambda: socket.gethostbyname("heliopanel.example"),
        lambda: socket.gethostbyaddr("192.0.2.1"),
        lambda: socket.getnameinfo(ELSEWHERE, 0),
        lambda: socket.create_connection(("heliopanel.example", 80), 1),
        lambda: on_socket(lambda one: one.connect(("heliopanel.example", 80))),
        lambda: on_socket(lambda one: one.bind(("heliopanel.example", 80))),
        lambda: on_socket(lambda one: one.connect(("2001:db8::1", 80)), family=socket.AF_INET6),
        lambda: on_socket(lambda one: one.connect(("::ffff:192.0.2.1", 80)), family=socket.AF_INET6),
        lambda: on_socket(lambda one: one.sendto(b"x", ("224.0.0.251", 5353)), type=socket.SOCK_DGRAM),
        lambda: uvloop.run(asyncio.open_connection("heliopanel.example", 80)),
    ],
)
def test_no_name_is_looked_up_and_no_other_address_called(ask: Callable[[], object]) -> None:
    with pytest.raises((PermissionError, socket.gaierror), match="Tests stay on this computer"):
        ask()
