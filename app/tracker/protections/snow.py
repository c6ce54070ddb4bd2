"""SNOW of Xia et al. (2015): a panel that carries snow for a while is tipped to shed it."""

from dataclasses import dataclass
from datetime import datetime, timedelta

from app.tracker.settings.protections import SnowProtection


@dataclass(frozen=True, slots=True)
class Snow:
    """Since when it holds, and when the panel was last not seen loaded; steady time."""

    since: datetime | None = None
    clear_at: datetime | None = None


CLEAR = Snow()


def step(state: Snow, limits: SnowProtection, load_kg: float | None, now: datetime) -> Snow:
    """Return the state after one look at the load of one panel, kg; None is not known.

    The load must be there for at least the delay, from the last look without it. An unknown load begins that
    time anew, and ends nothing. That the wind forbids it is the business of `priority.classify`.
    """
    if state.since is not None:
        released = load_kg is not None and load_kg < limits.load_kg - limits.hysteresis_kg
        return Snow(None, now) if released else state
    if load_kg is None or load_kg < limits.load_kg:
        return Snow(None, now)
    clear_at = state.clear_at or now
    lain = now - clear_at >= timedelta(seconds=limits.hold_s)
    return Snow(now if lain else None, clear_at)
