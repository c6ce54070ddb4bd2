"""What each mount can do, and what its axes, modes and zero are called: one table for all doors."""

from collections.abc import Mapping
from dataclasses import dataclass

from app.base.message import N_, Message, Word, join, say
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import MountConfig, MountKind, TrackerConfig
from app.tracker.values.mode import Mode


@dataclass(frozen=True, slots=True)
class AxisWords:
    """The name of an axis, which way its angle grows and falls, and where it is zero."""

    title: Message
    grows: Message
    falls: Message
    zero: Message


@dataclass(frozen=True, slots=True)
class MountAbilities:
    """What a mount is and which modes it has, by the names that people read; `second` None: no such axis.

    `backtracks`: it may stand in rows. `sightings`: views of the sun can correct its pointing, and
    `leans`: also for a mast that is not upright.
    """

    title: Message
    summary: Message
    first: AxisWords
    second: AxisWords | None
    modes: Mapping[Mode, Message]
    backtracks: bool
    sightings: bool
    leans: bool


_AZIMUTH = AxisWords(
    N_("Azimuth"), N_("east (clockwise)"), N_("west (counterclockwise)"), N_("the panel faces true north")
)
_ELEVATION = AxisWords(
    N_("Elevation"), N_("up"), N_("down"), N_("the panel is vertical and faces the horizon")
)
_ROTATION = AxisWords(
    N_("Rotation"),
    N_("to the right of the axis's direction"),
    N_("to the left of the axis's direction"),
    N_("the panel is level across the axis"),
)
_SINGLE_MODES = {Mode.FIXED: N_("Fixed"), Mode.AZIMUTH: N_("Single-axis tracking")}

ABILITIES: dict[MountKind, MountAbilities] = {
    MountKind.AZIMUTH_ELEVATION: MountAbilities(
        title=N_("Azimuth and elevation"),
        summary=N_(
            "Two axes: a vertical axis that turns the panel in azimuth, and a horizontal axis "
            "that tilts the panel."
        ),
        first=_AZIMUTH,
        second=_ELEVATION,
        modes={
            Mode.FIXED: N_("Fixed"),
            Mode.AZIMUTH: N_("Azimuth tracking"),
            Mode.ELEVATION: N_("Elevation tracking"),
            Mode.DUAL: N_("Dual-axis tracking"),
        },
        backtracks=False,
        sightings=True,
        leans=True,
    ),
    MountKind.EQUATORIAL: MountAbilities(
        title=N_("Equatorial"),
        summary=N_(
            "Two axes: one parallel to the earth's axis, which follows the hour angle through "
            "the day, and one across it, which follows the declination through the year."
        ),
        first=AxisWords(
            N_("Hour angle"),
            N_("west (afternoon)"),
            N_("east (morning)"),
            N_("the panel faces the meridian, as at solar noon"),
        ),
        second=AxisWords(
            N_("Declination"),
            N_("north"),
            N_("south"),
            N_("the panel faces the celestial equator, as at the equinox"),
        ),
        modes={
            Mode.FIXED: N_("Fixed"),
            Mode.AZIMUTH: N_("Diurnal tracking"),
            Mode.ELEVATION: N_("Seasonal tracking"),
            Mode.DUAL: N_("Dual-axis tracking"),
        },
        backtracks=False,
        sightings=False,
        leans=False,
    ),
    MountKind.HORIZONTAL_SINGLE_AXIS: MountAbilities(
        title=N_("Horizontal single axis"),
        summary=N_("One horizontal axis, mostly north to south: the panel rolls from east to west."),
        first=_ROTATION,
        second=None,
        modes=_SINGLE_MODES,
        backtracks=True,
        sightings=False,
        leans=False,
    ),
    MountKind.TILTED_SINGLE_AXIS: MountAbilities(
        title=N_("Tilted single axis"),
        summary=N_("One tilted axis, mostly toward the equator: the panel rolls from east to west."),
        first=_ROTATION,
        second=None,
        modes=_SINGLE_MODES,
        backtracks=True,
        sightings=False,
        leans=False,
    ),
    MountKind.VERTICAL_SINGLE_AXIS: MountAbilities(
        title=N_("Vertical single axis"),
        summary=N_("One vertical axis: the panel keeps its tilt and turns in azimuth."),
        first=AxisWords(
            N_("Rotation"),
            N_("clockwise, seen from above"),
            N_("counterclockwise, seen from above"),
            N_("the panel faces the azimuth that is set for the axis"),
        ),
        second=None,
        modes=_SINGLE_MODES,
        backtracks=False,
        sightings=False,
        leans=False,
    ),
}


def abilities(mount: MountConfig) -> MountAbilities:
    """Return what a mount can do."""
    return ABILITIES[mount.kind]


def axis_words(mount: MountConfig, axis: Axis) -> AxisWords | None:
    """Return the words for an axis, None if the mount does not have it."""
    known = abilities(mount)
    return known.first if axis is Axis.AZIMUTH else known.second


def default_mode(mount: MountConfig) -> Mode:
    """Return the mode in which every axis of a mount follows the sun."""
    return Mode.AZIMUTH if mount.single_axis else Mode.DUAL


def zero_words(mount: MountConfig) -> Message:
    """Return where the axes of a mount are zero, in one part of a sentence."""
    known = abilities(mount)
    words = [known.first] if known.second is None else [known.first, known.second]
    return join(
        "; ", (say("{title}: {zero}", title=Word(axis.title.lower()), zero=axis.zero) for axis in words)
    )


def axis_of(config: TrackerConfig, axis: Axis) -> Message:
    """Return "azimuth axis of T1", for a sentence."""
    return say("{mount} axis of {name}", mount=axis_title(config.mount, axis), name=config.name)


def axis_title(mount: MountConfig, axis: Axis) -> Word:
    """Return what people call an axis of this mount, in a sentence."""
    words = axis_words(mount, axis)
    return Word("second") if words is None else Word(words.title.lower())
