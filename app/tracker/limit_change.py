"""Another range or speed of an axis: what differs, what forbids it now, and what to be sure of."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from app.tracker.axes import Axis, AxisConfig
from app.tracker.config import TrackerConfig
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.reason import Reason

VALUES = (
    ("minimum_deg", "lower soft limit", "°"),
    ("maximum_deg", "upper soft limit", "°"),
    ("speed_dps", "rated speed", "°/s"),
    ("acceleration_dps2", "acceleration", "°/s²"),
)


class Standing(Protocol):
    """Where an axis stands, degrees of the axis, and which of its limit switches are on."""

    @property
    def position_deg(self) -> float | None:
        """Return its angle, None where that is not known."""

    @property
    def at_lower_limit(self) -> bool:
        """Return whether its lower switch is on."""

    @property
    def at_upper_limit(self) -> bool:
        """Return whether its upper switch is on."""


@dataclass(frozen=True, slots=True)
class Difference:
    """One value that a change would change, for people: what it is, as it was, and as it would be."""

    what: str
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class LimitReview:
    """What a change of limits or speeds asks: `against` forbids it now, `doubts` are to be confirmed."""

    differences: tuple[Difference, ...] = ()
    against: tuple[Reason, ...] = ()
    doubts: tuple[Reason, ...] = ()

    @property
    def digest(self) -> str:
        """Return what stands for exactly these differences, so that no others are confirmed."""
        return "; ".join(f"{one.what}: {one.before} to {one.after}" for one in self.differences)


def review(
    old: TrackerConfig, new: TrackerConfig, stands: dict[Axis, Standing], *, trusted: bool
) -> LimitReview:
    """Return the differences of two configurations, judged against where the axes stand.

    `trusted` says that the zero is, so that angles mean something; `stands` lacks an axis that is not known.
    """
    differences: list[Difference] = []
    against: list[Reason] = []
    doubts: list[Reason] = []
    for axis in new.mount.axes:
        differences.extend(_differences(new, axis, old.axis(axis), new.axis(axis)))
        if trusted and axis in stands and _range(old.axis(axis)) != _range(new.axis(axis)):
            against.extend(_forbidden(new, axis, stands[axis]))
        doubts.extend(_doubts(old, new, axis))
    if doubts and not trusted:
        doubts.append(_NO_ZERO)
    return LimitReview(tuple(differences), tuple(against), tuple(doubts))


def _range(axis: AxisConfig) -> tuple[float, float]:
    return axis.minimum_deg, axis.maximum_deg


def _differences(config: TrackerConfig, axis: Axis, old: AxisConfig, new: AxisConfig) -> Iterator[Difference]:
    title = axis_title(config.mount, axis).capitalize()
    for name, words, unit in VALUES:
        before, after = getattr(old, name), getattr(new, name)
        if before != after:
            yield Difference(f"{title}, {words}", f"{before:g} {unit}", f"{after:g} {unit}")


def _forbidden(config: TrackerConfig, axis: Axis, seen: Standing) -> Iterator[Reason]:
    """Yield why an axis cannot have this range where it stands."""
    limits, at_deg = config.axis(axis), seen.position_deg
    if at_deg is None:
        return
    name = axis_of(config, axis)
    if limits.beyond_deg(at_deg) > config.in_position_deg:
        yield Reason(
            "outside_new_limits",
            f"The {name} is at {at_deg:.1f} degrees, outside the new soft limits "
            f"{limits.minimum_deg:g} to {limits.maximum_deg:g} degrees.",
            "Move the axis inside the limits first, then save.",
        )
    ends = (
        (seen.at_lower_limit, "lower", limits.minimum_deg < at_deg - config.in_position_deg),
        (seen.at_upper_limit, "upper", limits.maximum_deg > at_deg + config.in_position_deg),
    )
    for pressed, end, lies_beyond in ends:
        if pressed and lies_beyond:
            yield Reason(
                "limit_beyond_switch",
                f"The {end} limit switch of the {name} is on at {at_deg:.1f} degrees; the new {end} soft "
                "limit lies beyond it.",
                (
                    "Set the soft limit before the switch. If the axis is not at its end, check the "
                    "home position."
                ),
            )


def _doubts(old: TrackerConfig, new: TrackerConfig, axis: Axis) -> Iterator[Reason]:
    """Yield what a person has to be sure of: more room and more speed than were allowed before."""
    before, after, name = old.axis(axis), new.axis(axis), axis_of(new, axis)
    room_deg = max(before.minimum_deg - after.minimum_deg, after.maximum_deg - before.maximum_deg)
    if room_deg > 0.0:
        yield Reason(
            "limits_widened",
            f"The {name} may turn {room_deg:g} degrees further than before.",
            (
                "Make sure that nothing is in the way, that no cable is too short, and that a limit "
                "switch follows."
            ),
        )
    if after.speed_dps > before.speed_dps or after.acceleration_dps2 > before.acceleration_dps2:
        yield Reason(
            "faster_than_before",
            f"The {name} may turn faster than before and needs a longer stopping distance.",
            "Repeat the stop test on the Drive tests page.",
        )


_NO_ZERO = Reason(
    "limits_without_zero",
    "The tracker is not homed: the axis positions in the new range are not known.",
    "Set the home position in step 3, Homing, before you rely on the limits.",
)
