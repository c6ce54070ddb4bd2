"""TYPHOON of Xia et al. (2015): wind stows the panel at once, and tracking goes on after calm minutes."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.settings.protections import WindProtection


@dataclass(frozen=True, slots=True)
class Wind:
    """What is known of the wind, m/s: its gust and its mean. None is not known, which is never calm.

    `doubted` says that a sensor has been bad for so long that the wind counts as high.
    """

    gust_mps: float | None
    mean_mps: float | None = None
    doubted: bool = False


@dataclass(frozen=True, slots=True)
class WindStow:
    """Since when it holds, and when the wind was last not seen calm; steady time."""

    since: datetime | None = None
    unsafe_at: datetime | None = None

    def earliest_end(self, limits: WindProtection) -> datetime | None:
        """Return when it ends if it stays calm from now on."""
        if self.since is None or self.unsafe_at is None:
            return None
        return self.unsafe_at + timedelta(seconds=limits.resume_after_s)


CALM = WindStow()


def step(state: WindStow, limits: WindProtection, wind: Wind, now: datetime) -> WindStow:
    """Return the state after one look at the wind.

    "Hits 17" and "declines to 17" meet at 17: a wind that equals a limit is unsafe. It ends once the wind was
    calm for *more* than the delay; every other look, an unknown wind included, begins that time anew.
    """
    if is_high(limits, wind):
        return WindStow(state.since or now, now)
    if state.since is None:
        return state
    if state.unsafe_at is None or not _is_calm(limits, wind):
        return WindStow(state.since, now)
    over = now - state.unsafe_at > timedelta(seconds=limits.resume_after_s)
    return CALM if over else state


def is_high(limits: WindProtection, wind: Wind) -> bool:
    """Return whether the wind has reached one of its limits, or counts as if it had."""
    gust, mean = wind.gust_mps, wind.mean_mps
    return (
        wind.doubted
        or (gust is not None and gust >= limits.gust_mps)
        or (mean is not None and mean >= limits.mean_mps)
    )


def _is_calm(limits: WindProtection, wind: Wind) -> bool:
    """Return whether the wind is known to be below its limits by more than the hysteresis."""
    gust, mean = wind.gust_mps, wind.mean_mps
    return (
        gust is not None
        and gust < limits.gust_mps - limits.hysteresis_mps
        and (mean is None or mean < limits.mean_mps - limits.hysteresis_mps)
    )
