"""The functions a formula needs, for one number or for an array: so that every formula is written once."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
PER_DEGREE = math.pi / 180.0
PER_RADIAN = 180.0 / math.pi
T = TypeVar("T", float, NDArray[np.float64])


@dataclass(frozen=True, slots=True)
class Trigonometry(Generic[T]):
    """Trigonometric functions of radians over one kind of number; `wrap` is the value modulo a length."""

    sin: Callable[[T], T]
    cos: Callable[[T], T]
    tan: Callable[[T], T]
    atan2: Callable[[T, T], T]
    hypot: Callable[[T, T], T]
    sqrt: Callable[[T], T]
    floor: Callable[[T], T]
    wrap: Callable[[T, float], T]


def _wrap_number(value: float, length: float) -> float:
    return value % length


def _wrap_array(value: Array, length: float) -> Array:
    """Return `value % length` at a fifth of its cost; rounding may leave a value at either end."""
    return np.asarray(value - length * np.floor(value / length), dtype=np.float64)


SCALAR: Trigonometry[float] = Trigonometry(
    math.sin, math.cos, math.tan, math.atan2, math.hypot, math.sqrt, math.floor, _wrap_number
)
ARRAY: Trigonometry[Array] = Trigonometry(
    np.sin, np.cos, np.tan, np.arctan2, np.hypot, np.sqrt, np.floor, _wrap_array
)
