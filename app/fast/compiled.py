"""The compiler, where it is installed: without numba the same functions run as plain Python."""

from collections.abc import Callable
from typing import Any, Final, TypeVar, cast

try:
    from numba import njit
except ImportError:
    installed = False
else:
    installed = True

COMPILED: Final = installed
"""Whether the extra `fast` is installed."""
ARITHMETIC = {"reassoc", "contract", "arcp", "nsz", "nnan"}
"""What the compiler may assume, so that loops become vector code: sums in any order, and no NaN comes in."""

F = TypeVar("F", bound=Callable[..., Any])


def compiled(function: F) -> F:
    """Return a loop over arrays as machine code that is kept on disk for the next process."""
    return _compiled(function, cache=True)


def inlined(function: F) -> F:
    """Return a formula that is written into the loops that call it."""
    return _compiled(function, inline="always")


def _compiled(function: F, **options: Any) -> F:
    """Compile with NumPy's division: by zero it gives infinity."""
    if not COMPILED:
        return function
    return cast(F, njit(fastmath=ARITHMETIC, error_model="numpy", **options)(function))
