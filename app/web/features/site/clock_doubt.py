"""Whether a clock is likely to be wrong: it differs from that of the device at hand, or from the present."""

from collections.abc import Iterator
from datetime import datetime, timedelta

from app.base.instants import duration, read_instant
from app.base.message import NOTHING, Message, say, with_format
from app.link.messages import SiteDetail
from app.sun.position import Algorithm, InstantRefused, Location, SunPosition, sun_position
from app.tracker.access.location_change import MOST_APART, against_another_clock, doing
from app.tracker.commands.commands import CommandRejected
from app.tracker.state.snapshot import SiteSnapshot
from app.web.shell.deps import Panel
from app.web.shell.formats import local


def clock_doubt(clock: datetime, device: datetime | None) -> Message:
    """Return the question before a clock is trusted, nothing where the device agrees or is not known."""
    if device is None or abs(clock - device) <= MOST_APART:
        return NOTHING
    length = duration(abs(clock - device) / timedelta(seconds=1))
    if clock > device:
        return say(
            "The controller's clock is {length} ahead of this device's clock. Which one is right?",
            length=length,
        )
    return say(
        "The controller's clock is {length} behind this device's clock. Which one is right?", length=length
    )


def doubt_beside(
    moves: tuple[Message, ...], clock: datetime, device: datetime | None, present: datetime
) -> Message:
    """Return the question before a clock is trusted where the moves that are asked about do not say the same.

    They do where the device agrees with the present clock.
    """
    says_the_same = moves and device is not None and abs(present - device) <= MOST_APART
    return NOTHING if says_the_same else clock_doubt(clock, device)


def refuse_before_asking(by: timedelta, now: SiteSnapshot | None) -> None:
    """Raise `CommandRejected` where the clock cannot be moved by so much: it is in vain to ask about it."""
    if reasons := against_another_clock(by, doing(now.trackers if now else ())):
        raise CommandRejected(*reasons)


def clock_moves(
    present: datetime, new: datetime, zone: str, location: Location | None
) -> tuple[Message, ...]:
    """Return what a new clock would change, nothing where it moves the site's by no more than a minute."""
    return () if abs(new - present) <= MOST_APART else tuple(_moves(present, new, zone, location))


def _moves(present: datetime, new: datetime, zone: str, location: Location | None) -> Iterator[Message]:
    length = duration(abs(new - present))
    if new > present:
        yield say("The controller's clock would be set forward by {length}.", length=length)
    else:
        yield say("The controller's clock would be set back by {length}.", length=length)
    yield say("It would show {at} ({zone}).", at=local(new, zone, "%Y-%m-%d %H:%M:%S"), zone=zone)
    if location is None:
        return
    try:
        before, after = (sun_position(Algorithm.PSA, location, at) for at in (present, new))
    except InstantRefused:
        return
    yield say("Sun: {before} to {after}.", before=_seen(before), after=_seen(after))


def _seen(sun: SunPosition) -> Message:
    return say(
        "{azimuth_deg}°, {elevation_deg}°",
        azimuth_deg=with_format(sun.azimuth_deg, ".1f"),
        elevation_deg=with_format(sun.apparent_elevation_deg, ".1f"),
    )


def site_moves(built: Panel, detail: SiteDetail, new: datetime, zone: str) -> tuple[Message, ...]:
    """Return what a new clock would change; refuse it where a tracker is led by the present one."""
    present = built.site_now()
    refuse_before_asking(new - present, built.machine.latest())
    return clock_moves(present, new, zone, detail.site.location)


def told_instant(at: str) -> datetime | None:
    """Return what a page tells of a clock, None where its browser did not tell."""
    try:
        instant = read_instant(at)
    except ValueError:
        return None
    return instant if instant.tzinfo else None


def answer_to(differences: tuple[timedelta, ...]) -> str:
    """Return what stands for exactly these differences, in a question about them."""
    return " ".join(f"{one.total_seconds():.0f}" for one in differences)


def is_answer(confirmed: str, differences: tuple[timedelta, ...]) -> bool:
    """Return whether these differences were confirmed, none of them over a minute off what was asked."""
    try:
        named = [int(one) for one in confirmed.split()]
    except ValueError:
        return False
    most_s = MOST_APART.total_seconds()
    pairs = zip(named, differences, strict=False)
    return len(named) == len(differences) and all(
        abs(one - by.total_seconds()) <= most_s for one, by in pairs
    )
