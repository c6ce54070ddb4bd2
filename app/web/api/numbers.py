"""Numbers are numbers: true and "150" are refused where a number is wanted, at any depth of what comes in."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from datetime import timedelta
from typing import Any, TypeVar

from pydantic import BaseModel, ModelWrapValidatorHandler, ValidationError
from pydantic_core import InitErrorDetails, PydanticCustomError

from app.base.message import N_

T = TypeVar("T")
Where = tuple[str | int, ...]

DIGITS = re.compile(r"\s*[-+]?[\d._]+\s*")
NO_NUMBER = PydanticCustomError("number_type", N_("This must be a number, without quotation marks."))
NO_BOOLEAN = PydanticCustomError("bool_type", N_("This must be true or false."))


def true_to_kind(given: Any, handler: ModelWrapValidatorHandler[T]) -> T:
    """Return what was read of what was given, or raise for numbers that were none and booleans likewise."""
    taken = handler(given)
    wrong = [
        InitErrorDetails(type=error, loc=where, input=value)
        for where, value, error in _posing(given, taken, ())
    ]
    if wrong:
        raise ValidationError.from_exception_data("request", wrong)
    return taken


def no_boolean(given: object) -> object:
    """Return what was given, or raise for a truth value: true would be taken for the literal 1."""
    if isinstance(given, bool):
        raise NO_NUMBER
    return given


def _posing(given: Any, taken: Any, where: Where) -> Iterator[tuple[Where, Any, PydanticCustomError]]:
    """Yield where a value was read as another kind than it was written."""
    if isinstance(taken, bool):
        if not isinstance(given, bool):
            yield where, given, NO_BOOLEAN
    elif isinstance(taken, int | float | timedelta):
        if isinstance(given, bool) or (isinstance(given, str) and DIGITS.fullmatch(given)):
            yield where, given, NO_NUMBER
    else:
        for place, inner_given, inner_taken in _inside(given, taken):
            yield from _posing(inner_given, inner_taken, (*where, place))


def _inside(given: Any, taken: Any) -> Iterator[tuple[str | int, Any, Any]]:
    """Yield the parts of what was given, each with what was read of it."""
    if isinstance(given, Mapping):
        for name, value in given.items():
            if (read := _part(taken, name)) is not None:
                yield str(name), value, read
    elif isinstance(given, Sequence) and not isinstance(given, str | bytes):
        parts = list(taken) if isinstance(taken, Sequence | frozenset | set) else []
        ordered = isinstance(taken, Sequence)
        for place, value in enumerate(given):
            if parts:
                yield place, value, parts[place] if ordered else parts[0]


def _part(taken: Any, name: Any) -> Any:
    """Return a part of what was read by the name under which it was given, None where there is none."""
    if isinstance(taken, Mapping):
        return taken.get(name)
    if isinstance(taken, BaseModel):
        return getattr(taken, _attribute(taken, str(name)), None)
    if is_dataclass(taken) and name in {field.name for field in fields(taken)}:
        return getattr(taken, str(name))
    return None


def _attribute(model: BaseModel, name: str) -> str:
    return next((own for own, field in type(model).model_fields.items() if field.alias == name), name)
