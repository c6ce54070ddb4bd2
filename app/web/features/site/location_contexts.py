"""What the page of the location shows: the form, the map, the sun now, and what is asked."""

from dataclasses import dataclass
from typing import ClassVar

from app.base.message import Message
from app.web.shell.contexts import Form, Frame


@dataclass(frozen=True, slots=True)
class MapMark:
    """A mark on a map and its label, in percent of the map's width and height.

    `kind` is `place`, the entered location; `doubted`, the same while it is asked about; `other`, the one
    that may be meant instead; or `sun`. The label is above the mark unless it is `below`.
    """

    kind: str
    x: float
    y: float
    label: str = ""
    label_x: float = 0.0
    below: bool = False


@dataclass(frozen=True, slots=True)
class SiteMap:
    """A part of the world's map, as an SVG view box, with the night as path data, empty if not known."""

    view_box: str
    night: str
    marks: tuple[MapMark, ...]
    sun: MapMark | None


@dataclass(frozen=True, slots=True)
class SunRow:
    """The sun now at one location, as texts; `zone` tells two locations apart at night."""

    kind: str
    tag: str
    azimuth: str
    elevation: str
    is_down: bool
    zone: str | Message


@dataclass(frozen=True, slots=True)
class LocationPreview:
    """What a location means: today's sun there, all texts in local time.

    `is_pair` tells that one field had both coordinates: the form has each in its own.
    """

    is_pair: bool
    normal: str
    zone: str
    zone_offset: str
    rise: str
    transit: str
    set: str
    noon_elevation: str
    polar: Message


@dataclass(frozen=True, slots=True)
class PlaceQuestion:
    """What is asked before a location is saved that is likely to be mistaken.

    `instead` is what the safe key sends, empty where no other location is likelier. `asked_for` stands for
    exactly the location that is asked about. `doubted` are the fields that are likely to be mistaken.
    """

    sentences: tuple[Message, ...]
    instead: str
    instead_label: Message
    keep_label: Message
    asked_for: str
    doubted: str
    is_compared: bool


@dataclass(frozen=True, slots=True)
class LocationPage:
    """Step 1; with `is_part`, what stands outside of the form is renewed beside it."""

    template: ClassVar[str] = "location.html"

    frame: Frame
    form: Form
    preview: LocationPreview | None
    map: SiteMap
    larger: SiteMap
    rows: tuple[SunRow, ...]
    zones: tuple[str, ...]
    by_place: str
    question: PlaceQuestion | None
    is_part: bool
