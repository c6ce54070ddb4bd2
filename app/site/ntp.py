"""What the kernel knows about the synchronisation of the system clock."""

import ctypes
import sys

TIME_ERROR = 5
TIMEX_BYTES = 512


def ntp_synchronised() -> bool | None:
    """Return whether the kernel's clock is disciplined by NTP, None where that cannot be asked."""
    if not sys.platform.startswith("linux"):
        return None
    state = int(ctypes.CDLL(None).adjtimex(ctypes.create_string_buffer(TIMEX_BYTES)))
    return None if state < 0 else state != TIME_ERROR
