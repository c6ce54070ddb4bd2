"""How far other settings move what the panel aims at: what differs, and how far each axis's target moves."""

from collections.abc import Iterator
from datetime import datetime, timedelta

from app.base.angles import wrap180
from app.base.message import N_, Message, join, say, with_format, word
from app.sun.position import InstantRefused, Location, SunPosition, sun_position
from app.tracker.memory.memory import Pointing, TrackerMemory, TrackerState
from app.tracker.motion.limit_change import TARGET_MOVES, Difference, LimitReview
from app.tracker.mounts.capabilities import axis_of
from app.tracker.mounts.mount import AxisTarget, aim, mode_direction
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.declared import declared
from app.tracker.values.mode import Mode
from app.tracker.values.reason import Reason

LOOKED_AHEAD = timedelta(hours=24)
EVERY = timedelta(minutes=30)
WEEKS_LOOKED_AHEAD = 27
"""No sun stays down for longer than half a year."""
MOST_UNASKED_DEG = 1.0
"""So far a target may move unasked: as far as the sun does in four minutes."""
AIMS = tuple(
    one
    for path, one in declared(TrackerConfig).items()
    if path in ("algorithm", "refraction") or path.startswith("mount.")
)
"""The settings by which a panel is aimed, its limits aside."""
CORRECTIONS = {
    "azimuth_offset_deg": N_("Azimuth offset"),
    "elevation_offset_deg": N_("Elevation offset"),
    "lean_north_deg": N_("Mast tilt to the north"),
    "lean_east_deg": N_("Mast tilt to the east"),
}

Course = tuple[AxisTarget | None, ...]


def aims_alike(old: TrackerConfig, new: TrackerConfig) -> bool:
    """Return whether two configurations aim the panel alike: by the same settings, within the same limits."""
    ranges = all(
        (before.minimum_deg, before.maximum_deg) == (after.minimum_deg, after.maximum_deg)
        for before, after in ((old.axis(axis), new.axis(axis)) for axis in Axis)
    )
    return ranges and all(one.of(old) == one.of(new) for one in AIMS)


def target_review(
    old: TrackerState,
    new: TrackerState,
    location: Location | None,
    at: datetime,
    stands_deg: float | None = None,
) -> LimitReview:
    """Return what differs and how far the targets move within 24 hours, where anybody has to be sure of it.

    `stands_deg` is where the first axis stands: of equivalent angles the nearest counts. Where the sun stays
    down for 24 hours, a later day with sun is looked at, week by week. A tracker that cannot track yet,
    for want of a home position, a mode or a location, is asked nothing, and neither is one that loses its
    home position by the change.
    """
    if location is None or not (_can_track(old.memory) and _can_track(new.memory)) or _is_other(old, new):
        return LimitReview()
    before, after = _courses(old, new, location, at, stands_deg)
    is_coming = any(before) or any(after)
    if not is_coming:
        before, after = _next_day(old, new, location, at)
    doubts = tuple(_doubts(new.config, before, after, is_coming=is_coming))
    return LimitReview(tuple(_differences(old, new)), (), doubts) if doubts else LimitReview()


def _can_track(memory: TrackerMemory) -> bool:
    return memory.home is not None and memory.mode is not None


def _is_other(old: TrackerState, new: TrackerState) -> bool:
    """Return whether the home position is lost by the change."""
    before, after = old.config, new.config
    actuators = any(before.axis(axis).actuator != after.axis(axis).actuator for axis in Axis)
    return before.mount.kind is not after.mount.kind or before.drive != after.drive or actuators


def _courses(
    old: TrackerState, new: TrackerState, location: Location, at: datetime, stands_deg: float | None
) -> tuple[Course, Course]:
    """Return where the axes should be each half hour from an instant on, and would be; None with no sun."""
    before: list[AxisTarget | None] = []
    after: list[AxisTarget | None] = []
    axis = old.config.azimuth
    near_deg = (axis.minimum_deg + axis.maximum_deg) / 2.0 if stands_deg is None else stands_deg
    for number in range(LOOKED_AHEAD // EVERY + 1):
        target = axis_target(old, location, at + number * EVERY, near_deg)
        near_deg = near_deg if target is None else target.azimuth_deg
        before.append(target)
        after.append(axis_target(new, location, at + number * EVERY, near_deg))
    return tuple(before), tuple(after)


def _next_day(
    old: TrackerState, new: TrackerState, location: Location, at: datetime
) -> tuple[Course, Course]:
    """Return the courses of the first day with sun, looked for week by week."""
    found: tuple[Course, Course] = ((), ())
    for week in range(1, WEEKS_LOOKED_AHEAD + 1):
        found = _courses(old, new, location, at + timedelta(weeks=week), None)
        if any(found[0]) or any(found[1]):
            break
    return found


def axis_target(
    tracker: TrackerState, location: Location, at: datetime, near_deg: float
) -> AxisTarget | None:
    """Return where the axes of a tracker would be at an instant if it tracked, None with no sun to follow.

    Of equivalent angles of the first axis, in degrees, the nearest to `near_deg` counts.
    """
    config, memory = tracker.config, tracker.memory
    sun = _sun(config, location, at, held=memory.mode is Mode.FIXED)
    if sun is None:
        return None
    wanted = mode_direction(
        memory.mode or Mode.DUAL, memory.orientation, sun, refraction=config.refraction, mount=config.mount
    )
    return aim(config, memory.pointing, wanted, near_deg)


def _sun(config: TrackerConfig, location: Location, at: datetime, *, held: bool) -> SunPosition | None:
    """Return the sun that is up; one that is down, too, where a `held` direction is faced day and night."""
    try:
        sun = sun_position(config.algorithm, location, at)
    except InstantRefused:
        return None
    return sun if held or sun.apparent_elevation_deg > 0.0 else None


def _doubts(config: TrackerConfig, before: Course, after: Course, *, is_coming: bool) -> Iterator[Reason]:
    """Yield of each axis how far its target moves, if that is more than goes unasked."""
    for axis in config.mount.axes:
        old, new = _angles(axis, before), _angles(axis, after)
        apart = wrap180 if axis is Axis.AZIMUTH else float  # both unwind, a moment apart
        moved = [abs(apart(b - a)) for a, b in zip(old, new, strict=True) if a is not None and b is not None]
        if not moved or max(moved) <= MOST_UNASKED_DEG:
            continue
        told = {"axis": axis_of(config, axis), "most_deg": with_format(max(moved), ".1f")}
        if is_coming:
            most = say(
                "The target of the {axis} moves by up to {most_deg}° within the next 24 hours.", **told
            )
            yield Reason(TARGET_MOVES, join(" ", (most, *_now(old[0], new[0]))), _HINT)
        else:
            later = say(
                "The target of the {axis} moves by up to {most_deg}° once the sun is up again.", **told
            )
            yield Reason(TARGET_MOVES, later, _HINT)


def _angles(axis: Axis, course: Course) -> list[float | None]:
    return [
        None if one is None else one.azimuth_deg if axis is Axis.AZIMUTH else one.elevation_deg
        for one in course
    ]


def _now(before_deg: float | None, after_deg: float | None) -> Iterator[Message]:
    if before_deg is not None and after_deg is not None:
        yield say(
            "At present, it is {before_deg}°; it would be {after_deg}°.",
            before_deg=with_format(before_deg, ".1f"),
            after_deg=with_format(after_deg, ".1f"),
        )


def _differences(old: TrackerState, new: TrackerState) -> Iterator[Difference]:
    for one in AIMS:
        before, after, unit = one.of(old.config), one.of(new.config), one.setting.unit
        if before != after:
            yield Difference(join("", (word(one.label),)), _written(before, unit), _written(after, unit))
    yield from _corrections(old.memory.pointing, new.memory.pointing)


def _corrections(old: Pointing, new: Pointing) -> Iterator[Difference]:
    for name, title in CORRECTIONS.items():
        before, after = getattr(old, name), getattr(new, name)
        if before != after:
            yield Difference(title, f"{before:.2f}°", f"{after:.2f}°")


def _written(value: object, unit: str) -> str:
    if value is None or isinstance(value, bool):
        return N_("on") if value else N_("off")
    text = f"{value:g}" if isinstance(value, float) else str(value)
    return f"{text} {unit}".strip()


_HINT = N_(
    "Nothing moves now; the panel goes there when it tracks again. Check the new values at the tracker."
)
