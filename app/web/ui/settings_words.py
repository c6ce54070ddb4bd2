"""What every number of a tracker's settings means: label, unit, range and default, for form and search."""

from dataclasses import dataclass

from app.tracker.config import TrackerConfig

DEFAULT = TrackerConfig("T1", "")


@dataclass(frozen=True, slots=True)
class SettingWords:
    """One setting: how it is called, its unit, least and most, the default, and what it does."""

    label: str
    unit: str
    least: float
    most: float
    default: float
    meaning: str

    @property
    def hint(self) -> str:
        """Return meaning, range and default as they stand below the field."""
        return f"{self.meaning} {self.least:g} to {self.most:g}, usual {self.default:g}."


def _axis(name: str, title: str) -> dict[str, SettingWords]:
    axis = DEFAULT.azimuth if name == "azimuth" else DEFAULT.elevation
    fast, slow = axis.jog_fast_dps, axis.jog_slow_dps
    return {
        f"{name}_minimum": SettingWords(
            f"{title}: lower soft limit", "°", -360, 360, axis.minimum_deg, "No motion goes below it."
        ),
        f"{name}_maximum": SettingWords(
            f"{title}: upper soft limit", "°", -360, 720, axis.maximum_deg, "No motion goes above it."
        ),
        f"{name}_speed": SettingWords(
            f"{title}: rated speed",
            "°/s",
            0.01,
            60,
            axis.speed_dps,
            "Highest speed that the drive can sustain.",
        ),
        f"{name}_acceleration": SettingWords(
            f"{title}: acceleration", "°/s²", 0.01, 100, axis.acceleration_dps2, "How quickly speed changes."
        ),
        f"{name}_slow": SettingWords(
            f"{title}: slow jog speed",
            "°/s",
            0.01,
            60,
            slow,
            "For the last degrees, with the hold-to-run buttons.",
        ),
        f"{name}_fast": SettingWords(
            f"{title}: fast jog speed", "°/s", 0.01, 60, fast, "At most the rated speed."
        ),
    }


SETTINGS = {
    "deadband": SettingWords(
        "Deadband",
        "°",
        0.01,
        10,
        DEFAULT.deadband_deg,
        "The panel moves when the pointing error exceeds this.",
    ),
    "in_position": SettingWords(
        "In-position tolerance",
        "°",
        0.01,
        5,
        DEFAULT.in_position_deg,
        "A move is complete within this distance of its target.",
    ),
    "following_error": SettingWords(
        "Following error",
        "°",
        0.1,
        20,
        DEFAULT.following_error_deg,
        "An axis with a larger error is stopped with a fault.",
    ),
    "park_azimuth": SettingWords(
        "Park azimuth", "°", 0, 360, DEFAULT.park.azimuth_deg, "Clockwise from true north."
    ),
    "park_elevation": SettingWords(
        "Park elevation", "°", 0, 90, DEFAULT.park.elevation_deg, "90 is a level panel, 0 an upright one."
    ),
    **_axis("azimuth", "Azimuth axis"),
    **_axis("elevation", "Elevation axis"),
}
