"""What makes a start quick: modules that are needed seldom come late, and the collector rests meanwhile."""

import ctypes
import gc
import sys
from functools import cache
from importlib import import_module
from types import ModuleType
from typing import Any, cast

SELDOM = (3_000, 5, 50)
"""Most of what a field makes is replaced, not lost in circles: usual thresholds look for those in vain, and
through everything there is, every few seconds and for longer than a tick may be late."""
OF_A_TRACKER = 200
"""So many more objects may be new before the youngest are looked through: what a storm leaves per tracker.

What is replaced counts as none, so that all that changed since is young: of 1,000 trackers 45 ms of it.
"""
RELAXED = (500_000, 50, 100)
"""More than any process loads."""
DISPENSABLE = ("pydantic.v1",)
"""What a library tries to load and does without where it is not: FastAPI asks whether a model is one of the
former pydantic's, of which there are none here, and 2 MB are loaded for the answer."""


@cache
def late(name: str) -> Any:
    """Return a module, imported now if it was not before."""
    return import_module(name)


def hurry() -> None:
    """Let the collector rest while modules are loaded, and load none that is dispensable.

    What is loaded stays, and looking through it takes a fifth of the time.
    """
    gc.set_threshold(*RELAXED)
    for name in DISPENSABLE:
        cast(dict[str, ModuleType | None], sys.modules).setdefault(name, None)


def settle(trackers: int = 0) -> None:
    """Leave what was loaded out of every later collection, and collect seldom from now on.

    A controller says how many trackers it has: the more there are, the more is new without being lost.

    It is not looked through before: of 154,000 objects 20 could go, and finding them took a tenth of the
    start. What loading took and let go of is given back to the system, where its C library can do that.
    """
    gc.freeze()
    first, second, third = SELDOM
    gc.set_threshold(first + OF_A_TRACKER * trackers, second, third)
    give_back = getattr(ctypes.CDLL(None), "malloc_trim", None)
    if give_back is not None:
        give_back(0)
