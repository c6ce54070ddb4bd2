"""A form of a page arrives whole or is refused: a field that is missing never counts as an empty one."""

from collections.abc import Callable, Iterable
from typing import Annotated, Any, get_origin, get_type_hints

from fastapi import params
from pydantic import BaseModel, BeforeValidator
from starlette.datastructures import FormData

from app.base.message import N_

INCOMPLETE = N_("The form arrived incomplete, and nothing was saved. Reload the page, then try again.")


class MayBeAbsent:
    """Marks a field that a page shows at times only; a form without it asks for nothing by it."""


MAY_BE_ABSENT = MayBeAbsent()


class FormIncomplete(Exception):
    """A form lacks a field that its page has."""

    def __init__(self) -> None:
        super().__init__(INCOMPLETE)


def _without_empty(values: Any) -> Any:
    return [one for one in values if one != ""] if isinstance(values, list | tuple) else values


CHECKED_ONLY = BeforeValidator(_without_empty)
"""For a list of checkboxes: the empty value beside them says that they were there, and is none of them."""


def field_names(endpoint: Callable[..., Any]) -> frozenset[str]:
    """Return the fields that the form of a route always has, as the route declares them."""
    found: set[str] = set()
    for name, hint in get_type_hints(endpoint, include_extras=True).items():
        told = getattr(hint, "__metadata__", ())
        if get_origin(hint) is not Annotated or not any(isinstance(one, params.Form) for one in told):
            continue
        kind = hint.__origin__
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            fields = kind.model_fields.items()
            found.update(name for name, field in fields if MAY_BE_ABSENT not in field.metadata)
        elif MAY_BE_ABSENT not in told:
            found.add(name)
    return frozenset(found)


def refuse_incomplete(form: FormData, names: Iterable[str]) -> None:
    """Raise `FormIncomplete` unless a form has every one of these fields."""
    if not form.keys() >= set(names):
        raise FormIncomplete
