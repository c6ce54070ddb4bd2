"""A network of one's own with nothing but a loopback: Linux refuses whatever would leave this computer."""

import os
import shutil
import socket
import struct
import subprocess
import sys

from tests.loopback import sitecustomize as guard

INSIDE = "HELIOPANEL_TEST_ALONE"
UNSHARE = ("unshare", "--user", "--map-root-user", "--net")
SET_FLAGS, UP = 0x8914, 0x1
"""SIOCSIFFLAGS and IFF_UP of Linux."""


def may_be_alone() -> bool:
    """Return whether this computer lets us have a network of our own."""
    if shutil.which(UNSHARE[0]) is None:
        return False
    return subprocess.run([*UNSHARE, "true"], capture_output=True, check=False).returncode == 0


def begin_alone(*module: str) -> None:
    """Go on as `python -m module ...` in a network of its own where that is allowed, and say which it is."""
    guard.stay_here()
    if INSIDE in os.environ:
        raise_loopback()
        print("Runs in a network namespace: no address but loopback can be reached.", flush=True)
    elif may_be_alone():
        os.execvpe(UNSHARE[0], [*UNSHARE, sys.executable, "-m", *module], os.environ | {INSIDE: "1"})  # noqa: S606 - nothing of it comes from outside
    else:
        print(
            "No network namespace is allowed here: every Python process refuses to call any address but "
            "loopback; programs that are no Python are not held.",
            flush=True,
        )


def raise_loopback() -> None:
    """Switch the loopback of this network on."""
    import fcntl  # noqa: PLC0415 - Linux alone has it

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(any_socket, SET_FLAGS, struct.pack("16sh22x", b"lo", UP))
