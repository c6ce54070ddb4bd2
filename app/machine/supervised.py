"""What a process that the supervisor started owes it: it tells that it works, and ends with it."""

import ctypes
import os
import signal
from collections.abc import Sequence
from contextlib import suppress

SUPERVISED = "--supervised="
READY = "SUPERVISED_READY_PIPE"
"""Names the pipe through which a child tells that it has begun to work."""
PR_SET_PDEATHSIG = 1


def end_with_supervisor(arguments: Sequence[str]) -> None:
    """End with the supervisor, where arguments name the process id of one."""
    for argument in arguments:
        if argument.startswith(SUPERVISED):
            end_with_parent(int(argument.removeprefix(SUPERVISED)))


def end_with_parent(parent: int) -> None:
    """Have the kernel send SIGTERM here when the supervisor dies; end now if it is dead already."""
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:
        raise SystemExit(0)


def tell_ready() -> None:
    """Tell the supervisor, where there is one, that this child has begun to work."""
    descriptor = os.environ.pop(READY, None)
    if descriptor is not None:
        with suppress(OSError), os.fdopen(int(descriptor), "wb", buffering=0) as pipe:
            pipe.write(b"1")
