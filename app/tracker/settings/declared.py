"""A setting is declared once, at its field: everything that shows, reads, or checks it is made from that.

Bounds are those of `annotated_types`; `Setting` has the rest. Modules that declare settings must not
postpone their annotations.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from enum import Enum, auto
from functools import cache, partial
from math import inf, isfinite
from sys import maxsize
from types import NoneType, UnionType
from typing import Annotated, Any, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt, MaxLen, MinLen

from app.base.message import N_, Message, join, say, with_format, word

STRICTLY = 1e-3
"""How far a shown bound keeps from one that is not itself allowed."""


NUMBER = ".10g"
"""How bounds and defaults are written."""
ENDS = (("ge", "gt"), ("le", "lt"))
BEYOND = ("greater_than_equal", "greater_than", "less_than_equal", "less_than", "finite_number")
"""What pydantic calls them, and what is beyond them."""
HINTS = {
    (True, True): N_("{meaning} {least} to {most}, usual {default}."),
    (True, False): N_("{meaning} {least} to {most}."),
    (False, True): N_("{least} to {most}, usual {default}."),
    (False, False): N_("{least} to {most}."),
}
"""What stands below a field, by whether it has a meaning and a default."""


class More(Enum):
    """What a greater value gives the machine: before it gets more than it had, somebody is asked."""

    ROOM = auto()
    LESS_ROOM = auto()
    SPEED = auto()


@dataclass(frozen=True, slots=True)
class Setting:
    """What a field is called, its unit, what it does, what more of it gives, and the words of its choices."""

    label: str
    unit: str = ""
    help: str = ""
    more: More | None = None
    choices: tuple[tuple[str, str], ...] = ()

    def __get_pydantic_core_schema__(self, source: Any, handler: Callable[[Any], Any]) -> Any:
        """Return how the field is read: what lies beyond its bounds is refused in the words of `refusal`."""
        schema = handler(source)
        low, high = (next((schema[name] for name in names if name in schema), None) for names in ENDS)
        if low is None or high is None:
            return schema
        read = partial(_read, refusal(self.label, low, high))
        return {"type": "function-wrap", "function": {"type": "no-info", "function": read}, "schema": schema}

    def __get_pydantic_json_schema__(self, core_schema: Any, handler: Callable[[Any], Any]) -> Any:
        """Return the schema of the field with its label, meaning, and unit."""
        unit = ("Unit:", f"{self.unit}.") if self.unit else ()
        told = {"title": str(self.label), "description": " ".join((self.help, *unit)).strip()}
        schema = handler(core_schema) | {name: text for name, text in told.items() if text}
        return schema | {"x-unit": self.unit} if self.unit else schema


def called(group: str, label: str) -> Message:
    """Return what a setting of a group is called, such as `Wind: Gust threshold`."""
    return join(": ", (word(group), word(label)))


def refusal(label: str, least: float, most: float) -> Message:
    """Return what is said of a value beyond its bounds."""
    return say(
        "{label} must be between {least} and {most}.",
        label=word(label),
        least=with_format(least, NUMBER),
        most=with_format(most, NUMBER),
    )


def _read(refused: Message, value: Any, handler: Callable[[Any], Any]) -> Any:
    """Return a value as pydantic reads it; it raises a `ValueError` that has `errors`."""
    try:
        return handler(value)
    except ValueError as error:
        found: Any = error
        if found.errors(include_url=False)[0]["type"] in BEYOND:
            raise ValueError(refused) from error
        raise


class Parts:
    """What is declared of the fields of a class that others use too, where it is a setting."""

    def __init__(self, **annotations: Any) -> None:
        self.annotations = annotations


@dataclass(frozen=True, slots=True)
class Declared:
    """One setting of a class: where it lies, the groups that it lies in, and all that is declared of it."""

    path: str
    groups: tuple[Setting, ...]
    setting: Setting
    kind: Any
    is_optional: bool
    low: float
    high: float
    is_open: tuple[bool, bool]
    lengths: tuple[int, int]
    default: Any

    @property
    def name(self) -> str:
        """Return the name of the field."""
        return self.path.rpartition(".")[2]

    @property
    def is_number(self) -> bool:
        """Return whether it is set as a number."""
        return self.kind in (int, float)

    @property
    def label(self) -> str:
        """Return how it is called among the settings of its group."""
        return self.setting.label

    @property
    def title(self) -> str:
        """Return how it is called where its group has to be told too."""
        return called(self.groups[-1].label, self.label) if self.groups else self.label

    @property
    def least(self) -> float:
        """Return the lowest value, as a person is told it."""
        return self.low + STRICTLY * self.is_open[0]

    @property
    def most(self) -> float:
        """Return the highest value, as a person is told it."""
        return self.high - STRICTLY * self.is_open[1]

    @property
    def longest(self) -> int:
        """Return how many characters a text may have at most."""
        return self.lengths[1]

    @property
    def meaning(self) -> str:
        """Return what it does."""
        return self.setting.help

    @property
    def hint(self) -> Message:
        """Return meaning, range, and default as they stand below a field."""
        if self.kind is str:
            return say(
                "{meaning} At most {longest} characters.", meaning=word(self.meaning), longest=self.longest
            )
        template = HINTS[bool(self.meaning), self.default is not None]
        numbers = {"least": self.least, "most": self.most, "default": self.default}
        shown = {name: with_format(value, NUMBER) for name, value in numbers.items() if value is not None}
        return say(template, meaning=word(self.meaning), **shown)

    @property
    def refusal(self) -> Message:
        """Return what is said of a value beyond its bounds."""
        return refusal(self.title, self.least, self.most)

    def holds(self, value: float) -> bool:
        """Return whether a number lies within the bounds."""
        above = self.low < value if self.is_open[0] else self.low <= value
        below = value < self.high if self.is_open[1] else value <= self.high
        return above and below and isfinite(value)

    def of(self, settings: Any) -> Any:
        """Return the value that settings have of it, None where they lack the group."""
        return _at(settings, self.path)


def declared(kind: type[Any]) -> Mapping[str, Declared]:
    """Return every setting of a dataclass by its path, those of dataclasses in it included."""
    key: Any = kind
    return _declared(key)


@cache
def _declared(kind: Any) -> Mapping[str, Declared]:
    return {one.path: one for one in _walk(annotations_of(kind), "", (), default_of(kind))}


def check(settings: Any) -> None:
    """Raise `ValueError` where a number lies beyond its bounds."""
    kind: Any = type(settings)
    for name, one in _own(kind):
        value = getattr(settings, name)
        if value is not None and not one.holds(value):
            raise ValueError(one.refusal)


def wrong(settings: Any) -> Iterator[Message]:
    """Yield a sentence for every number that lies beyond its bounds, at any depth."""
    for one in declared(type(settings)).values():
        value = one.of(settings)
        if one.is_number and value is not None and not one.holds(value):
            yield one.refusal


def bare(annotation: Any) -> tuple[Any, bool, tuple[Any, ...]]:
    """Return a field's type without what is annotated, whether None is one of its values, and the notes."""
    notes: tuple[Any, ...] = ()
    is_optional = False
    while True:
        if get_origin(annotation) is Annotated:
            annotation, *more = get_args(annotation)
            notes += tuple(more)
        elif get_origin(annotation) in (Union, UnionType) and NoneType in get_args(annotation):
            others = tuple(arm for arm in get_args(annotation) if arm is not NoneType)
            annotation, is_optional = Union[others], True  # noqa: UP007
        else:
            return annotation, is_optional, notes


def setting_of(notes: tuple[Any, ...]) -> Setting | None:
    """Return what is declared of a field, None where it is not set by anybody."""
    return next((note for note in notes if isinstance(note, Setting)), None)


@cache
def _own(kind: Any) -> tuple[tuple[str, Declared], ...]:
    """Return the numbers of a class itself: classes in it check their own."""
    found = declared(kind).items()
    return tuple((path, one) for path, one in found if "." not in path and one.is_number)


def annotations_of(kind: Any, notes: tuple[Any, ...] = ()) -> dict[str, Any]:
    """Return the annotation of every field of a class, as it is declared where the class is a setting."""
    parts = next((note.annotations for note in notes if isinstance(note, Parts)), {})
    return {field.name: parts.get(field.name, field.type) for field in fields(kind)}


def default_of(kind: Any) -> dict[str, Any]:
    """Return the default of every field of a class that has one."""
    plain = {field.name: field.default for field in fields(kind) if field.default is not MISSING}
    made = ((field.name, field.default_factory) for field in fields(kind))
    return plain | {name: make() for name, make in made if make is not MISSING}


def _walk(
    annotations: dict[str, Any], path: str, groups: tuple[Setting, ...], usual: dict[str, Any]
) -> Iterator[Declared]:
    for name, noted in annotations.items():
        annotation, is_optional, notes = bare(noted)
        setting, place, default = setting_of(notes), f"{path}{name}", usual.get(name)
        if isinstance(annotation, type) and is_dataclass(annotation):
            parts = annotations_of(annotation, notes)
            inner = default_of(annotation) if default is None else _values(default)
            yield from _walk(parts, f"{place}.", (*groups, setting) if setting else groups, inner)
        elif setting is not None:
            low, high, is_open = _bounds(notes)
            yield Declared(
                place, groups, setting, annotation, is_optional, low, high, is_open, _lengths(notes), default
            )


def _lengths(notes: tuple[Any, ...]) -> tuple[int, int]:
    shortest = next((note.min_length for note in notes if isinstance(note, MinLen)), 0)
    return shortest, next((note.max_length for note in notes if isinstance(note, MaxLen)), maxsize)


def _values(settings: Any) -> dict[str, Any]:
    return {field.name: getattr(settings, field.name) for field in fields(settings)}


def _bounds(notes: tuple[Any, ...]) -> tuple[float, float, tuple[bool, bool]]:
    low: Any = -inf
    high: Any = inf
    below = above = False
    for note in notes:
        match note:
            case Ge(ge=bound):
                low = bound
            case Gt(gt=bound):
                low, below = bound, True
            case Le(le=bound):
                high = bound
            case Lt(lt=bound):
                high, above = bound, True
    return low, high, (below, above)


def _at(settings: Any, path: str) -> Any:
    for name in path.split("."):
        settings = getattr(settings, name, None)
    return settings
