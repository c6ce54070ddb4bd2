"""What the templates of the protections page are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.web.contexts import Form, Frame

Options = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Setting:
    """One number that is set: its field, how it is called, its unit, and range, default and meaning."""

    name: str
    label: str
    unit: str
    hint: str


@dataclass(frozen=True, slots=True)
class Group:
    """The settings of one protection: its name in the form, its title, what it does, its fields."""

    name: str
    title: str
    text: str
    settings: tuple[Setting, ...]
    reactions: Options


@dataclass(frozen=True, slots=True)
class ProtectionsPage:
    """What holds now, and what is set for the protections of one tracker."""

    template: ClassVar[str] = "protections.html"

    frame: Frame
    form: Form
    groups: tuple[Group, ...]
    facings: Options
    stows: Options
    fixed: tuple[Setting, ...]
