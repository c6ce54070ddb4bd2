"""Sightings of the sun: stored one by one, fitted to a pointing correction."""

from dataclasses import replace
from datetime import timedelta

from app.base.message import N_, Word, say, with_format
from app.link.messages import ApplySightings, TakeSighting
from app.site.loop.loop import TrackerLoop
from app.site.orders.tracker_setup import refuse_another_aim
from app.site.state.model import SiteModel
from app.tracker.commands.commands import CommandRejected
from app.tracker.commissioning.alignment import pointing_of
from app.tracker.commissioning.sun_clock import clock_error
from app.tracker.memory.memory import Sighting
from app.tracker.mounts.capabilities import abilities
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import Event, EventKind
from app.tracker.values.reason import Reason

MOST_SIGHTINGS = 50
SAID_BY_THE_SUN = "clock_off"
"""What views of the sun may say must not keep from taking more of them."""


async def take(model: SiteModel, command: TakeSighting, actor: str) -> tuple[Event, ...]:
    """Store where sun and panel stand now, as one sighting."""
    tracker_id = command.tracker_id
    loop = model.tracker(tracker_id)
    sighting = _sighting(model, loop)
    taken = (*loop.memory.sightings, sighting)[-MOST_SIGHTINGS:]
    event = model.event(
        EventKind.SIGHTING_TAKEN,
        say(
            "A sighting was taken: sun at azimuth {sun_azimuth_deg}, elevation "
            "{sun_elevation_deg}; axes at {panel_azimuth_deg}, {panel_elevation_deg} degrees.",
            sun_azimuth_deg=with_format(sighting.sun_azimuth_deg, ".2f"),
            sun_elevation_deg=with_format(sighting.sun_elevation_deg, ".2f"),
            panel_azimuth_deg=with_format(sighting.panel_azimuth_deg, ".2f"),
            panel_elevation_deg=with_format(sighting.panel_elevation_deg, ".2f"),
        ),
        actor,
        tracker_id,
    )
    memory = replace(loop.memory, sightings=taken)
    await model.ledger.save_tracker(replace(loop.state, memory=memory), (event,))
    loop.controller.set_sightings(taken)
    ask_the_sun(model)
    return (event,)


def ask_the_sun(model: SiteModel) -> None:
    """Judge the clock by the views of the sun since it was set; of trackers that tell, the worst counts."""
    model.timekeeper.offset.by_sun = max(
        filter(None, (_clock_error(model, loop) for loop in model.loops.values())), key=abs, default=None
    )


def _clock_error(model: SiteModel, loop: TrackerLoop) -> timedelta | None:
    place, set_at = model.state.location, model.state.clock.set_at
    if place is None:
        return None
    since = tuple(one for one in loop.memory.sightings if set_at is None or one.at > set_at)
    return clock_error(since, place, loop.config.algorithm, refraction=loop.config.refraction)


def _sighting(model: SiteModel, loop: TrackerLoop) -> Sighting:
    seen = model.observe(loop.config, loop.feedback)
    sun, feedback = seen.sun, seen.feedback
    reasons = []
    if sun is None or sun.apparent_elevation_deg <= 0.0:
        reasons.append(
            Reason("sun_down", N_("The sun is not up."), N_("Take the sighting while the sun is out."))
        )
    if feedback is None:
        reasons.append(
            Reason("drive_lost", N_("The drive does not answer."), N_("Check supply and connection."))
        )
    elif feedback.azimuth.moving or feedback.elevation.moving:
        reasons.append(
            Reason("moving", N_("The panel is moving."), N_("Wait until the panel is at standstill."))
        )
    if loop.memory.home is None:
        reasons.append(Reason("not_homed", N_("The axes are not homed."), N_("Complete step 3 first.")))
    reasons.extend(reason for reason in model.timekeeper.reasons() if reason.code != SAID_BY_THE_SUN)
    reasons.extend(_no_sightings(loop.config))
    if reasons or sun is None or feedback is None:
        raise CommandRejected(*reasons)
    elevation_deg = sun.apparent_elevation_deg if loop.config.refraction else sun.elevation_deg
    return Sighting(
        seen.site_time,
        sun.azimuth_deg,
        elevation_deg,
        feedback.azimuth.position_deg,
        feedback.elevation.position_deg,
    )


def _no_sightings(config: TrackerConfig) -> tuple[Reason, ...]:
    """Return that views of the sun do not correct the pointing of this mount."""
    known = abilities(config.mount)
    if known.sightings:
        return ()
    return (
        Reason(
            "mount_without_sightings",
            say(
                "The pointing of a {lower} mount cannot be corrected with sun sightings.",
                lower=Word(known.title.lower()),
            ),
            N_(
                "Align the axis, set its azimuth and tilt on the mount page, and set the home "
                "position with a level."
            ),
        ),
    )


async def apply(model: SiteModel, given: ApplySightings, actor: str) -> tuple[Event, ...]:
    """Correct with what the kept sightings fit to; none: forget the correction."""
    loop = model.tracker(given.tracker_id)
    refuse_another_aim(loop)
    if given.keep and (reasons := _no_sightings(loop.config)):
        raise CommandRejected(*reasons)
    pointing = pointing_of(given.keep)
    message = (
        say("The mounting correction was fitted to {keep} sightings.", keep=len(given.keep))
        if given.keep
        else N_("The mounting correction was removed.")
    )
    event = model.event(EventKind.TRACKER_CHANGED, message, actor, given.tracker_id)
    memory = replace(loop.memory, sightings=given.keep, pointing=pointing)
    await model.ledger.save_tracker(replace(loop.state, memory=memory), (event,))
    loop.controller.set_sightings(given.keep)
    loop.controller.set_pointing(pointing)
    ask_the_sun(model)
    return (event,)
