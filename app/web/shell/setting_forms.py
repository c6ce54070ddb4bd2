"""The fields of a form, made from where the settings are declared: what they show, and what was typed."""

from collections.abc import Iterable
from enum import Enum
from typing import Any, TypeVar

from pydantic import ValidationError

from app.base.adapter import adapter
from app.base.message import say, told_of_value, word
from app.tracker.settings.declared import Declared, declared
from app.tracker.values.typed_numbers import written
from app.web.shell.contexts import SettingRow
from app.web.shell.forms import Typed, Unreadable, clean_name

T = TypeVar("T")
CHECKED = "yes"


def field_name(path: str) -> str:
    """Return the name of the form's field for a setting."""
    return path.replace(".", "_")


def row(one: Declared) -> SettingRow:
    """Return the field of a setting: its name, label, unit, hint, and how it is typed."""
    mode = "numeric" if one.kind is int else "decimal" if one.kind is float else "text"
    kind = "check" if one.kind is bool else "choice" if issubclass(one.kind, Enum) else mode
    hint = one.hint if one.is_number or one.kind is str else one.meaning
    return SettingRow(field_name(one.path), one.label, one.setting.unit, hint, kind, one.setting.choices)


def rows(settings: Iterable[Declared]) -> tuple[SettingRow, ...]:
    """Return the fields of settings, in the order in which they are declared."""
    return tuple(map(row, settings))


def below(kind: type[Any], group: str) -> tuple[Declared, ...]:
    """Return the settings of a class that lie in a group themselves; those of no group for an empty name."""
    start = f"{group}." if group else ""
    return tuple(
        one
        for path, one in declared(kind).items()
        if path.startswith(start) and "." not in path.removeprefix(start)
    )


def texts(settings: Any, chosen: Iterable[Declared] | None = None) -> dict[str, str]:
    """Return what is set as the texts of a form."""
    wanted = declared(type(settings)).values() if chosen is None else chosen
    return {field_name(one.path): text(one.of(settings), one.most) for one in wanted}


def text(value: Any, most: float) -> str:
    """Return one value as the text of its field; `most` ends the range of a number."""
    if isinstance(value, bool):
        return CHECKED if value else ""
    if isinstance(value, float):
        return written(value, most)
    return "" if value is None else str(value)


def typed_value(typed: Typed, one: Declared, title: str = "") -> Any:
    """Return what was typed for one setting; what is wrong is noted in `typed`."""
    name, label = field_name(one.path), title or one.title
    given = typed.text(name)
    if one.kind is bool:
        return bool(given)
    if issubclass(one.kind, Enum):
        return typed.read(name, lambda text: _chosen(text, one), one.default)
    if one.is_optional and not given:
        return None
    if one.kind is int:
        return typed.whole(name, label, int(one.least), int(one.most), one.setting.unit)
    if one.is_number:
        return typed.number(name, label, one.least, one.most, one.setting.unit)
    return typed.read(name, lambda text: _short(text, one), "")


def typed_settings(typed: Typed, kind: type[T], **further: Any) -> T | None:
    """Return the settings that were typed, None while anything is wrong; `further` are read by the page."""
    found: dict[str, Any] = {}
    for path, one in declared(kind).items():
        if path not in further:
            put(found, path, typed_value(typed, one))
    return None if typed.errors else validated(typed, kind, found | further)


def validated(typed: Typed, kind: type[T], document: dict[str, Any]) -> T | None:
    """Return settings of a document; a rule about several that is broken is noted in `typed`."""
    try:
        return adapter(kind).validate_python(document)
    except ValidationError as error:
        for wrong in error.errors():
            typed.errors[_place(kind, wrong["loc"])] = told_of_value(wrong)
        return None


def put(found: dict[str, Any], path: str, value: Any) -> None:
    """Put a value into a document at its path."""
    *groups, name = path.split(".")
    for group in groups:
        found = found.setdefault(group, {})
    found[name] = value


def _place(kind: type[Any], where: tuple[int | str, ...]) -> str:
    """Return the field of what is wrong; a rule about several shows at the first number of their group."""
    start = ".".join(part for part in where if isinstance(part, str))
    numbers = [path for path, one in declared(kind).items() if one.is_number]
    return field_name(next((path for path in numbers if path.startswith(start)), numbers[0]))


def _short(text: str, one: Declared) -> str:
    shortest, longest = one.lengths
    text = clean_name(text)
    if not shortest <= len(text) <= longest:
        label = one.title
        raise Unreadable(
            say(
                "{label}: type {shortest} to {longest} characters.",
                label=word(label),
                shortest=shortest,
                longest=longest,
            )
        )
    return text


def _chosen(text: str, one: Declared) -> Any:
    if text not in (dict(one.setting.choices) or list(one.kind)):
        label = one.title
        raise Unreadable(say("{label}: choose one from the list.", label=word(label)))
    return one.kind(text)
