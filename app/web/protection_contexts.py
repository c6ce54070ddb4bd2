"""What the templates of the protections page are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.config import TrackerConfig
from app.web.contexts import Form, Frame
from app.web.ui.region_picture import RegionPicture

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
    """What holds now, and what is set for the protections of one tracker; `usual` are elevations of stows."""

    template: ClassVar[str] = "protections.html"

    frame: Frame
    form: Form
    groups: tuple[Group, ...]
    facings: Options
    stows: Options
    usual: dict[str, str]
    fixed: tuple[Setting, ...]


@dataclass(frozen=True, slots=True)
class ServicePage:
    """Who may move the machine now: the switch at the cabinet, service mode, the trust in the zero."""

    template: ClassVar[str] = "service.html"

    frame: Frame
    config: TrackerConfig
    blocked: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FaultRow:
    """One class of faults: its name in the form, its title, what it is, the codes of its faults."""

    name: str
    title: str
    text: str
    codes: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class MachinePage:
    """What is set for the protections of the machine itself: limits, recovery, forbidden regions.

    `places` are the numbers of the regions that the form shows; `picture` is None on a mount with one axis.
    """

    template: ClassVar[str] = "machine.html"

    frame: Frame
    config: TrackerConfig
    form: Form
    settings: tuple[Setting, ...]
    faults: tuple[FaultRow, ...]
    recoveries: Options
    places: tuple[int, ...]
    how: str
    picture: RegionPicture | None
