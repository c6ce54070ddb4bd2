"""What each mount can do, and what its axes, modes and zero are called: one table for all doors."""

from collections.abc import Mapping
from dataclasses import dataclass

from app.tracker.axes import Axis
from app.tracker.config import MountConfig, MountKind, TrackerConfig
from app.tracker.mode import Mode


@dataclass(frozen=True, slots=True)
class AxisWords:
    """The name of an axis, which way its angle grows and falls, and where it is zero."""

    title: str
    grows: str
    falls: str
    zero: str


@dataclass(frozen=True, slots=True)
class MountAbilities:
    """What a mount is and which modes it has, by the names that people read; `second` None: no such axis.

    `backtracks`: it may stand in rows. `sightings`: views of the sun can correct its pointing, and
    `leans`: also for a mast that is not upright.
    """

    title: str
    summary: str
    first: AxisWords
    second: AxisWords | None
    modes: Mapping[Mode, str]
    backtracks: bool
    sightings: bool
    leans: bool


_AZIMUTH = AxisWords("Azimuth", "east (clockwise)", "west (counterclockwise)", "the panel faces true north")
_ELEVATION = AxisWords("Elevation", "up", "down", "the panel is vertical and faces the horizon")
_ROTATION = AxisWords(
    "Rotation",
    "to the right of the axis's direction",
    "to the left of the axis's direction",
    "the panel is level across the axis",
)
_SINGLE_MODES = {Mode.FIXED: "Fixed", Mode.AZIMUTH: "Single-axis tracking"}

ABILITIES: dict[MountKind, MountAbilities] = {
    MountKind.AZIMUTH_ELEVATION: MountAbilities(
        title="Azimuth and elevation",
        summary=(
            "Two axes: a vertical axis that turns the panel in azimuth, and a horizontal axis "
            "that tilts the panel."
        ),
        first=_AZIMUTH,
        second=_ELEVATION,
        modes={
            Mode.FIXED: "Fixed",
            Mode.AZIMUTH: "Azimuth tracking",
            Mode.ELEVATION: "Elevation tracking",
            Mode.DUAL: "Dual-axis tracking",
        },
        backtracks=False,
        sightings=True,
        leans=True,
    ),
    MountKind.EQUATORIAL: MountAbilities(
        title="Equatorial",
        summary="Two axes: one parallel to the earth's axis, which follows the hour angle through "
        "the day, and one across it, which follows the declination through the year.",
        first=AxisWords(
            "Hour angle",
            "west (afternoon)",
            "east (morning)",
            "the panel faces the meridian, as at solar noon",
        ),
        second=AxisWords(
            "Declination", "north", "south", "the panel faces the celestial equator, as at the equinox"
        ),
        modes={
            Mode.FIXED: "Fixed",
            Mode.AZIMUTH: "Diurnal tracking",
            Mode.ELEVATION: "Seasonal tracking",
            Mode.DUAL: "Dual-axis tracking",
        },
        backtracks=False,
        sightings=False,
        leans=False,
    ),
    MountKind.HORIZONTAL_SINGLE_AXIS: MountAbilities(
        title="Horizontal single axis",
        summary="One horizontal axis, mostly north to south: the panel rolls from east to west.",
        first=_ROTATION,
        second=None,
        modes=_SINGLE_MODES,
        backtracks=True,
        sightings=False,
        leans=False,
    ),
    MountKind.TILTED_SINGLE_AXIS: MountAbilities(
        title="Tilted single axis",
        summary="One tilted axis, mostly toward the equator: the panel rolls from east to west.",
        first=_ROTATION,
        second=None,
        modes=_SINGLE_MODES,
        backtracks=True,
        sightings=False,
        leans=False,
    ),
    MountKind.VERTICAL_SINGLE_AXIS: MountAbilities(
        title="Vertical single axis",
        summary="One vertical axis: the panel keeps its tilt and turns in azimuth.",
        first=AxisWords(
            "Rotation",
            "clockwise, seen from above",
            "counterclockwise, seen from above",
            "the panel faces the azimuth that is set for the axis",
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


def zero_words(mount: MountConfig) -> str:
    """Return where the axes of a mount are zero, in one part of a sentence."""
    known = abilities(mount)
    words = [known.first] if known.second is None else [known.first, known.second]
    return "; ".join(f"{axis.title.lower()}: {axis.zero}" for axis in words)


def axis_of(config: TrackerConfig, axis: Axis) -> str:
    """Return "azimuth axis of T1", for a sentence."""
    return f"{axis_title(config.mount, axis)} axis of {config.name}"


def axis_title(mount: MountConfig, axis: Axis) -> str:
    """Return what people call an axis of this mount, in a sentence."""
    words = axis_words(mount, axis)
    return "second" if words is None else words.title.lower()
