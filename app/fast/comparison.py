"""What is asked and told about a site at a glance; it needs neither compiler nor pvlib."""

from dataclasses import dataclass

from app.sun.position import Location
from app.tracker.settings.config import Orientation
from app.tracker.values.mode import Mode


@dataclass(frozen=True, slots=True)
class ClearSky:
    """The air and the ground: altitude, Linke turbidity, the share of light that the ground gives back."""

    altitude_m: float = 0.0
    linke_turbidity: float = 3.0
    albedo: float = 0.2


@dataclass(frozen=True, slots=True)
class ModeWorth:
    """What a mode collects in the year, and how much more than the fixed panel."""

    mode: Mode
    collected_kwhm2: float
    gain_pct: float


@dataclass(frozen=True, slots=True)
class DeadbandWorth:
    """What following with a deadband means: a day's average, the greatest and the mean square error."""

    deadband_deg: float
    moves_a_day: float
    azimuth_travel_deg: float
    elevation_travel_deg: float
    worst_off_deg: float
    rms_off_deg: float


@dataclass(frozen=True, slots=True)
class Comparison:
    """A site at a glance; the deadbands were tried on so many `days` of the year."""

    year: int
    location: Location
    held: Orientation
    days: int
    modes: tuple[ModeWorth, ...]
    deadbands: tuple[DeadbandWorth, ...]
