"""What the templates of the protections page are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.settings.config import TrackerConfig
from app.web.charts.region_picture import RegionPicture
from app.web.shell.contexts import Form, Frame, SettingRow

Options = tuple[tuple[str, str], ...]


@dataclass(frozen=True, slots=True)
class Group:
    """The settings of one group: its name in the form, its title, what it does, its fields."""

    name: str
    title: str
    text: str
    settings: tuple[SettingRow, ...]


@dataclass(frozen=True, slots=True)
class ProtectionsPage:
    """What holds now, and what is set for the protections of one tracker."""

    template: ClassVar[str] = "protections.html"

    frame: Frame
    form: Form
    groups: tuple[Group, ...]
    stows: tuple[Group, ...]
    fixed: tuple[SettingRow, ...]


@dataclass(frozen=True, slots=True)
class ServicePage:
    """Who may move the machine now: the switch at the cabinet, service mode, the trust in the zero."""

    template: ClassVar[str] = "service.html"

    frame: Frame
    config: TrackerConfig
    blocked: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FaultRow:
    """One class of faults: what is set for it, and the codes of its faults."""

    group: Group
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
    settings: tuple[SettingRow, ...]
    faults: tuple[FaultRow, ...]
    places: tuple[int, ...]
    how: str
    picture: RegionPicture | None
