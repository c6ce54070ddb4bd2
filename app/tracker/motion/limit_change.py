"""Another range or speed of an axis: what differs, what forbids it now, and what to be sure of."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

from app.base.message import N_, Message, Word, join, say, with_format, word
from app.tracker.mounts.capabilities import axis_of, axis_title
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.declared import More, declared
from app.tracker.values.reason import Reason

TARGET_MOVES = "target_moves"
REVIEWED = tuple(one for one in declared(AxisConfig).values() if one.setting.more is not None)
"""What gives an axis more room or speed."""


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

    what: Message
    before: str
    after: str


@dataclass(frozen=True, slots=True)
class LimitReview:
    """What a change of limits, speeds or aim asks: `against` forbids it now, `doubts` are to be confirmed."""

    differences: tuple[Difference, ...] = ()
    against: tuple[Reason, ...] = ()
    doubts: tuple[Reason, ...] = ()

    @property
    def moves_target(self) -> bool:
        """Return whether the panel would be aimed elsewhere."""
        return any(one.code == TARGET_MOVES for one in self.doubts)

    @property
    def digest(self) -> Message:
        """Return what stands for exactly these differences, so that no others are confirmed."""
        return join(
            "; ",
            (
                say("{what}: {before} to {after}", what=one.what, before=one.before, after=one.after)
                for one in self.differences
            ),
        )


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
    for one in REVIEWED:
        before, after, unit = one.of(old), one.of(new), one.setting.unit
        if before != after:
            what = join(", ", (word(title), word(one.label.lower())))
            yield Difference(what, f"{before:g} {unit}", f"{after:g} {unit}")


def _forbidden(config: TrackerConfig, axis: Axis, seen: Standing) -> Iterator[Reason]:
    """Yield why an axis cannot have this range where it stands."""
    limits, at_deg = config.axis(axis), seen.position_deg
    if at_deg is None:
        return
    name = axis_of(config, axis)
    if limits.beyond_deg(at_deg) > config.in_position_deg:
        yield Reason(
            "outside_new_limits",
            say(
                "The {name} is at {at_deg} degrees, outside the new soft limits {minimum_deg} to "
                "{maximum_deg} degrees.",
                name=name,
                at_deg=with_format(at_deg, ".1f"),
                minimum_deg=with_format(limits.minimum_deg, "g"),
                maximum_deg=with_format(limits.maximum_deg, "g"),
            ),
            N_("Move the axis inside the limits first, then save."),
        )
    ends = (
        (seen.at_lower_limit, "lower", limits.minimum_deg < at_deg - config.in_position_deg),
        (seen.at_upper_limit, "upper", limits.maximum_deg > at_deg + config.in_position_deg),
    )
    for pressed, end, lies_beyond in ends:
        if pressed and lies_beyond:
            yield Reason(
                "limit_beyond_switch",
                say(
                    "The {end} limit switch of the {name} is on at {at_deg} degrees; the new {end2} soft "
                    "limit lies beyond it.",
                    end=Word(end),
                    name=name,
                    at_deg=with_format(at_deg, ".1f"),
                    end2=end,
                ),
                N_(
                    "Set the soft limit before the switch. If the axis is not at its end, check the "
                    "home position."
                ),
            )


def _doubts(old: TrackerConfig, new: TrackerConfig, axis: Axis) -> Iterator[Reason]:
    """Yield what a person has to be sure of: more room and more speed than were allowed before."""
    before, after, name = old.axis(axis), new.axis(axis), axis_of(new, axis)
    room_deg = max(_gained(before, after, More.ROOM), _gained(after, before, More.LESS_ROOM))
    if room_deg > 0.0:
        yield Reason(
            "limits_widened",
            say(
                "The {name} may turn {room_deg} degrees further than before.",
                name=name,
                room_deg=with_format(room_deg, "g"),
            ),
            N_(
                "Make sure that nothing is in the way, that no cable is too short, and that a limit "
                "switch follows."
            ),
        )
    if _gained(before, after, More.SPEED) > 0.0:
        yield Reason(
            "faster_than_before",
            say("The {name} may turn faster than before and needs a longer stopping distance.", name=name),
            N_("Repeat the stop test on the Drive tests page."),
        )


def _gained(before: AxisConfig, after: AxisConfig, more: More) -> float:
    """Return by how much the settings grow of which more gives this."""
    return max(float(one.of(after) - one.of(before)) for one in REVIEWED if one.setting.more is more)


_NO_ZERO = Reason(
    "limits_without_zero",
    N_("The tracker is not homed: the axis positions in the new range are not known."),
    N_("Set the home position in step 3, Homing, before you rely on the limits."),
)
