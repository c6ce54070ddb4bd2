"""What the kernel knows about the synchronisation of the system clock."""

import ctypes
import sys
from dataclasses import dataclass

TIME_ERROR = 5
STA_NANO = 0x2000


@dataclass(frozen=True, slots=True)
class KernelClock:
    """The kernel's word on its clock: whether NTP keeps it, and what is left to be added to it, seconds.

    Linux keeps no more than 0.5 s to be added: a clock that is further off is stepped, or nobody knows it.
    """

    synchronised: bool
    offset_s: float = 0.0


class _Timex(ctypes.Structure):
    """`struct timex` of adjtimex(2), as far as it is read; the rest is room for what the kernel writes."""

    _fields_ = (
        ("modes", ctypes.c_uint),
        ("offset", ctypes.c_long),
        ("freq", ctypes.c_long),
        ("maxerror", ctypes.c_long),
        ("esterror", ctypes.c_long),
        ("status", ctypes.c_int),
        ("rest", ctypes.c_char * 512),
    )


def kernel_clock() -> KernelClock | None:
    """Return what the kernel knows, None where it cannot be asked."""
    if not sys.platform.startswith("linux"):
        return None
    found = _Timex()
    state = int(ctypes.CDLL(None).adjtimex(ctypes.byref(found)))
    if state < 0:
        return None
    unit_s = 1e-9 if found.status & STA_NANO else 1e-6
    return KernelClock(state != TIME_ERROR, found.offset * unit_s)
