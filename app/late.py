"""What makes a start quick: modules that are needed seldom come late, and the collector rests meanwhile."""

import gc
from functools import cache
from importlib import import_module
from typing import Any

USUAL = gc.get_threshold()
RELAXED = (200_000, 50, 100)


@cache
def late(name: str) -> Any:
    """Return a module, imported now if it was not before."""
    return import_module(name)


def hurry() -> None:
    """Let the collector rest while modules are loaded: they stay, and looking through them takes a fifth."""
    gc.set_threshold(*RELAXED)


def settle() -> None:
    """Leave what was loaded out of every later collection, and collect as usual from now on."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(*USUAL)
