"""Over how long gust and mean are taken, and from which age on a value is not used any more."""

from dataclasses import dataclass, fields
from datetime import timedelta
from math import isfinite

from app.base.message import N_, say, with_format

USUAL_OLD_S = 300.0
LIMITS = {
    "gust_s": (N_("The window of the gust"), 1.0, 60.0),
    "mean_s": (N_("The window of the mean wind"), 60.0, 3600.0),
    "wind_old_after_s": (N_("The maximum age of wind data"), 5.0, 86_400.0),
    "light_old_after_s": (N_("The maximum age of irradiance data"), 5.0, 86_400.0),
    "snow_old_after_s": (N_("The maximum age of snow data"), 5.0, 86_400.0),
    "other_old_after_s": (N_("The maximum age of other data"), 5.0, 86_400.0),
}
OLD_AFTER = {
    "wind_mps": "wind_old_after_s",
    "wind_direction_deg": "wind_old_after_s",
    "irradiance_wm2": "light_old_after_s",
    "snow_kg": "snow_old_after_s",
    "snow_mm": "snow_old_after_s",
}


@dataclass(frozen=True, slots=True)
class WeatherWindows:
    """Lengths in seconds; a gust is of 3 s and a mean of 10 minutes, as WMO-No. 8 has them.

    Raises `ValueError` with a sentence for what is out of range.
    """

    gust_s: float = 3.0
    mean_s: float = 600.0
    wind_old_after_s: float = USUAL_OLD_S
    light_old_after_s: float = USUAL_OLD_S
    snow_old_after_s: float = USUAL_OLD_S
    other_old_after_s: float = USUAL_OLD_S

    def __post_init__(self) -> None:
        for name, (title, low, high) in LIMITS.items():
            value = getattr(self, name)
            if not (isfinite(value) and low <= value <= high):
                raise ValueError(
                    say(
                        "{title} must lie between {low} and {high} s.",
                        title=title,
                        low=with_format(low, "g"),
                        high=with_format(high, "g"),
                    )
                )

    @property
    def gust_over(self) -> timedelta:
        """Return over how long the gust is the highest wind."""
        return timedelta(seconds=self.gust_s)

    @property
    def mean_over(self) -> timedelta:
        """Return over how long the mean wind is taken."""
        return timedelta(seconds=self.mean_s)

    def old_after(self, name: str) -> timedelta:
        """Return from which age on a value of `Weather` is not used."""
        return timedelta(seconds=getattr(self, OLD_AFTER.get(name, "other_old_after_s")))

    @property
    def oldest(self) -> timedelta:
        """Return the age from which on no value at all is used."""
        ages_s = (getattr(self, field.name) for field in fields(self) if field.name.endswith("_old_after_s"))
        return timedelta(seconds=max(ages_s))


def same_age(old_after: timedelta) -> WeatherWindows:
    """Return the usual windows with one age for every value."""
    age_s = old_after.total_seconds()
    return WeatherWindows(3.0, 600.0, age_s, age_s, age_s, age_s)
