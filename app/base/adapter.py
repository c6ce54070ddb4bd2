"""What checks and writes a class, made when it is first used, and once for all who use it."""

from typing import Any, TypeVar

from pydantic import TypeAdapter

T = TypeVar("T")
_made: dict[Any, TypeAdapter[Any]] = {}


def adapter(shape: type[T]) -> TypeAdapter[T]:
    """Return the adapter of a class: making one takes up to 10 ms, and many are not used in one run."""
    if shape not in _made:
        _made[shape] = TypeAdapter(shape)
    return _made[shape]
