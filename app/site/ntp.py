"""What the kernel knows about the synchronisation of the system clock."""

import ctypes
import ctypes.util

TIME_ERROR = 5
TIMEX_BYTES = 512


def ntp_synchronised() -> bool | None:
    """Return whether the kernel's clock is disciplined by NTP, None where that cannot be asked."""
    library = ctypes.util.find_library("c")
    if library is None:
        return None
    adjtimex = getattr(ctypes.CDLL(library, use_errno=True), "adjtimex", None)
    if adjtimex is None:
        return None
    state = int(adjtimex(ctypes.create_string_buffer(TIMEX_BYTES)))
    return None if state < 0 else state != TIME_ERROR
