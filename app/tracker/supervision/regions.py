"""Forbidden regions: polygons of axis angles that the panel must not enter, judged on its path.

Both axes start together, each on its own trapezoid, so a path is bent: it is cut into short pieces, and each
piece counts as the rectangle that it lies in, grown by a margin. Angles are degrees of the axes.
"""

from itertools import pairwise
from math import sqrt
from typing import NamedTuple

from app.base.message import N_, say
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.settings.config import TrackerConfig
from app.tracker.settings.mechanics import Region
from app.tracker.state.activity import Jogging, MoveKind, Moving
from app.tracker.state.controller_state import HALTED, ControllerState
from app.tracker.state.snapshot import EventKind
from app.tracker.state.transitions import interrupt
from app.tracker.values.motion import AxisCommand, AxisFeedback, DriveCommand, Feedback, Halt, Position
from app.tracker.values.reason import Reason

MARGIN_DEG = 0.5
PIECES = 32
REACTION_S = 0.5


class Span(NamedTuple):
    """A stretch of one axis, from the lower to the upper end."""

    low: float
    high: float


def bar(state: ControllerState, command: DriveCommand, feedback: Feedback) -> DriveCommand:
    """Return the command; halted, and the activity ended, if it led into a forbidden region."""
    if not state.config.machine.regions or command is HALTED:
        return command
    region = entered(state.config, command, feedback)
    by_hand = isinstance(state.activity, Jogging) or (
        isinstance(state.activity, Moving) and state.activity.kind is MoveKind.STEP
    )
    if region is None or (by_hand and _stands_in(region, feedback)):
        return command
    reason = forbidden(state.config, region)
    state.say(EventKind.LIMIT_REACHED, reason.message, code=reason.code, region=region.name)
    interrupt(state, reason)
    return HALTED


def forbidden(config: TrackerConfig, region: Region) -> Reason:
    """Return that a motion would lead into a region."""
    return Reason(
        "forbidden_region",
        say(
            "The path of {name} would lead through the forbidden region {name2}.",
            name=config.name,
            name2=region.name,
        ),
        N_("Choose a position with a path around the region. If the panel is inside the region, jog it out."),
    )


def entered(config: TrackerConfig, command: DriveCommand, feedback: Feedback) -> Region | None:
    """Return the first region that the axes would enter on their way, or coming to rest on it."""
    ahead = (
        _ahead(config.axis(Axis.AZIMUTH), command.azimuth, feedback.azimuth),
        _ahead(config.axis(Axis.ELEVATION), command.elevation, feedback.elevation),
    )
    whole = _around(
        ahead, (_way(command.azimuth, feedback.azimuth), _way(command.elevation, feedback.elevation))
    )
    near = [region for region in config.machine.regions if touches(region, *whole)]
    if not near:
        return None
    pieces = [ahead, *path(config, command, feedback)]
    return next((region for region in near for piece in pieces if touches(region, *piece)), None)


def path(config: TrackerConfig, command: DriveCommand, feedback: Feedback) -> list[tuple[Span, Span]]:
    """Return the rectangles that the way from here to the commanded positions lies in."""
    legs = (
        (config.azimuth, command.azimuth, feedback.azimuth),
        (config.elevation, command.elevation, feedback.elevation),
    )
    whole_s = max(_lasts_s(*leg) for leg in legs)
    if whole_s <= 0.0:
        return []
    places = [[_at(*leg, whole_s * step / PIECES) for leg in legs] for step in range(PIECES + 1)]
    return [(_span(before[0], after[0]), _span(before[1], after[1])) for before, after in pairwise(places)]


def touches(region: Region, azimuth: Span, elevation: Span) -> bool:
    """Return whether a rectangle and a region have a point in common."""
    corners = [(corner.azimuth_deg, corner.elevation_deg) for corner in region.corners]
    beside = azimuth.high < min(x for x, _ in corners) or azimuth.low > max(x for x, _ in corners)
    if beside or elevation.high < min(y for _, y in corners) or elevation.low > max(y for _, y in corners):
        return False
    if any(azimuth.low <= x <= azimuth.high and elevation.low <= y <= elevation.high for x, y in corners):
        return True
    box = [(x, y) for x in azimuth for y in (elevation if x == azimuth.low else reversed(elevation))]
    if any(_inside(corners, point) for point in box):
        return True
    return any(_cross(a, b, c, d) for a, b in _edges(corners) for c, d in _edges(box))


def _stands_in(region: Region, feedback: Feedback) -> bool:
    here = feedback.azimuth.position_deg, feedback.elevation.position_deg
    return touches(region, _span(here[0], here[0]), _span(here[1], here[1]))


def _way(command: AxisCommand, seen: AxisFeedback) -> Span:
    """Return the stretch from here to where an axis is sent."""
    to_deg = command.position_deg if isinstance(command, Position) else seen.position_deg
    return _span(seen.position_deg, to_deg)


def _around(one: tuple[Span, Span], other: tuple[Span, Span]) -> tuple[Span, Span]:
    """Return the rectangle around two."""
    azimuth, elevation = (
        Span(min(a.low, b.low), max(a.high, b.high)) for a, b in zip(one, other, strict=True)
    )
    return azimuth, elevation


def _ahead(config: AxisConfig, command: AxisCommand, seen: AxisFeedback) -> Span:
    """Return the stretch that an axis needs to come to rest, gathering speed for the time of a reaction."""
    match command:
        case Halt():
            heading = 0.0
        case Position():
            heading = min(1.0, max(-1.0, command.position_deg - seen.position_deg)) * command.speed_dps
        case _:
            heading = command.velocity_dps
    speed_dps = max(abs(heading), abs(seen.velocity_dps))
    run_deg = speed_dps * REACTION_S + speed_dps**2 / (2.0 * config.acceleration_dps2)
    direction = heading or seen.velocity_dps
    if isinstance(command, Position):
        run_deg = min(run_deg, abs(command.position_deg - seen.position_deg))
    end_deg = seen.position_deg + (run_deg if direction > 0.0 else -run_deg if direction < 0.0 else 0.0)
    return _span(seen.position_deg, end_deg)


def _lasts_s(config: AxisConfig, command: AxisCommand, seen: AxisFeedback) -> float:
    if not isinstance(command, Position):
        return 0.0
    way_deg = abs(command.position_deg - seen.position_deg)
    rise_s = command.speed_dps / config.acceleration_dps2
    if way_deg <= command.speed_dps * rise_s:
        return 2.0 * sqrt(way_deg / config.acceleration_dps2)
    return way_deg / command.speed_dps + rise_s


def _at(config: AxisConfig, command: AxisCommand, seen: AxisFeedback, time_s: float) -> float:
    """Return where an axis is after a time on its trapezoid from rest."""
    if not isinstance(command, Position):
        return seen.position_deg
    way_deg = command.position_deg - seen.position_deg
    whole_s = _lasts_s(config, command, seen)
    if time_s >= whole_s:
        return command.position_deg
    half = time_s > whole_s / 2.0
    from_end_s = whole_s - time_s if half else time_s
    rise_s = min(command.speed_dps / config.acceleration_dps2, whole_s / 2.0)
    run_deg = config.acceleration_dps2 * min(from_end_s, rise_s) ** 2 / 2.0
    run_deg += command.speed_dps * max(0.0, from_end_s - rise_s)
    gone_deg = abs(way_deg) - run_deg if half else run_deg
    return seen.position_deg + (gone_deg if way_deg > 0.0 else -gone_deg)


def _span(one_deg: float, other_deg: float) -> Span:
    return Span(min(one_deg, other_deg) - MARGIN_DEG, max(one_deg, other_deg) + MARGIN_DEG)


Point = tuple[float, float]


def _edges(corners: list[Point]) -> list[tuple[Point, Point]]:
    return list(zip(corners, corners[1:] + corners[:1], strict=True))


def _inside(corners: list[Point], point: Point) -> bool:
    """Return whether a point lies in a polygon: a ray from it crosses its edges an odd number of times."""
    x, y = point
    crossed = False
    for (ax, ay), (bx, by) in _edges(corners):
        if (ay > y) != (by > y) and x < (bx - ax) * (y - ay) / (by - ay) + ax:
            crossed = not crossed
    return crossed


def _cross(a: Point, b: Point, c: Point, d: Point) -> bool:
    """Return whether two stretches cross."""
    return _side(a, b, c) != _side(a, b, d) and _side(c, d, a) != _side(c, d, b)


def _side(a: Point, b: Point, point: Point) -> bool:
    return (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) > 0.0
