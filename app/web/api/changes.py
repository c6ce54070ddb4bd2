"""What the API takes for a settings class `X`: `XChange`, made from where its settings are declared."""

from collections.abc import Mapping
from dataclasses import is_dataclass
from functools import cache
from typing import Annotated, Any, ClassVar, get_args

from pydantic import Field as Described
from pydantic import create_model

from app.tracker.settings.declared import Parts, annotations_of, bare, default_of, setting_of
from app.web.api.base import Clean, Input


class Change(Input):
    """What shall be different; what is left out stays, null stands for no value where there may be none."""

    nullable: ClassVar[frozenset[str]] = frozenset()


@cache
def change_of(kind: Any, parts: Parts | None = None) -> type[Change]:
    """Return the model of a change of a settings class: everything in it may be left out."""
    shapes: dict[str, Any] = {}
    nullable = set()
    for name, noted in annotations_of(kind, (parts,)).items():
        annotation, is_optional, notes = bare(noted)
        if setting := setting_of(notes):
            shape = _shape(annotation, notes, is_whole=is_optional)
            shapes[name] = (shape | None, Described(None, title=setting.label))
            nullable |= {name} if is_optional else set()
    made = create_model(f"{kind.__name__}Change", __base__=Change, __doc__=_about(kind), **shapes)
    made.nullable = frozenset(nullable)
    return made


@cache
def whole_of(kind: Any) -> type[Input]:
    """Return the model of settings that are given as a whole: only what has a default may be left out."""
    usual = default_of(kind)
    shapes: dict[str, Any] = {}
    for name, noted in annotations_of(kind).items():
        annotation, is_optional, notes = bare(noted)
        shape = _shape(annotation, notes, is_whole=True)
        shapes[name] = (shape | None if is_optional else shape, usual.get(name, ...))
    return create_model(f"{kind.__name__}In", __base__=Input, __doc__=_about(kind), **shapes)


def given(change: Change) -> dict[str, Any]:
    """Return what shall be different as JSON has it, without what stays."""
    return _without(change, change.model_dump(mode="json"))


def _without(change: Change, dumped: Mapping[str, Any]) -> dict[str, Any]:
    found = {}
    for name, value in dumped.items():
        inner = getattr(change, name)
        if isinstance(inner, Change):
            found[name] = _without(inner, value)
        elif value is not None or (name in change.nullable and name in change.model_fields_set):
            found[name] = value
    return found


def _shape(annotation: Any, notes: tuple[Any, ...], *, is_whole: bool) -> Any:
    """Return what a field takes, with its bounds and its description."""
    kind: Any = annotation
    if is_dataclass(annotation):
        parts = next((note for note in notes if isinstance(note, Parts)), None)
        annotation = whole_of(kind) if is_whole else change_of(kind, parts)
    elif kinds := [arm for arm in get_args(annotation) if is_dataclass(arm)]:
        notes = (*notes, Described(discriminator="kind")) if len(kinds) > 1 else notes
    elif annotation is str:
        notes = (Clean, *notes)
    return Annotated[annotation, *notes] if notes else annotation


def _about(kind: Any) -> str:
    return (kind.__doc__ or "").partition("\n")[0]
