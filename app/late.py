"""Modules that weigh much and are needed seldom: imported at their first use, not when the panel starts."""

from functools import cache
from importlib import import_module
from typing import Any


@cache
def late(name: str) -> Any:
    """Return a module, imported now if it was not before."""
    return import_module(name)
