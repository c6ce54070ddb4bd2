"""What makes a start quick: modules that are needed seldom come late, and the collector rests meanwhile."""

import ctypes
import gc
from functools import cache
from importlib import import_module
from typing import Any

SELDOM = (3_000, 5, 50)
"""Most of what a field makes is replaced, not lost in circles: usual thresholds look for those in vain, and
through everything there is, every few seconds and for longer than a tick may be late."""
RELAXED = (500_000, 50, 100)
"""More than any process loads."""


@cache
def late(name: str) -> Any:
    """Return a module, imported now if it was not before."""
    return import_module(name)


def hurry() -> None:
    """Let the collector rest while modules are loaded: they stay, and looking through them takes a fifth."""
    gc.set_threshold(*RELAXED)


def settle() -> None:
    """Leave what was loaded out of every later collection, and collect seldom from now on.

    It is not looked through before: of 154,000 objects 20 could go, and finding them took a tenth of the
    start. What loading took and let go of is given back to the system, where its C library can do that.
    """
    gc.freeze()
    gc.set_threshold(*SELDOM)
    give_back = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if give_back is not None:
        give_back(0)
