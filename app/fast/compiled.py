"""The compiler, where it is installed: without numba the same functions run as plain Python."""

from collections.abc import Callable
from typing import Any, Final, TypeVar

try:
    from numba import njit
except ImportError:
    njit = None

COMPILED: Final = njit is not None
"""Whether the extra `fast` is installed."""

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Return a loop over arrays as machine code that is kept on disk for the next process."""
    return _compiled(function, cache=True)


def inlined(function: F) -> F:
    """Return a formula that is written into the loops that call it."""
    return _compiled(function, inline="always")


def _compiled(function: F, **options: Any) -> F:
    """Compile for vector units: sums may be reordered, and a division by zero gives infinity, as in NumPy."""
    if njit is None:
        return function
    code: F = njit(fastmath={"reassoc", "contract", "arcp", "nsz", "nnan"}, error_model="numpy", **options)(function)
    return code
