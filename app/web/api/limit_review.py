"""Before limits, speeds, or what the panel aims by are saved: what differs, and what to be sure of."""

from dataclasses import replace

from starlette.requests import Request

from app.access.principal import ProofNeeded, Via
from app.access.sessions import is_proven
from app.base.message import N_
from app.link.messages import TrackerDetail
from app.tracker.access.location_change import against_another_aim, against_other_settings, doing
from app.tracker.commands.commands import CommandRejected
from app.tracker.memory.memory import TrackerState
from app.tracker.motion.limit_change import LimitReview, Standing, review
from app.tracker.motion.target_change import target_review
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.web.shell.deps import panel, principal

CONFIRMED = "confirmed"
"""The field that holds the differences which somebody was sure of; others are asked for again."""


def _refuse_before_asking(site: SiteSnapshot | None, tracker_id: str, found: LimitReview) -> None:
    """Raise `CommandRejected` where the tracker takes no such settings now: to ask would be in vain."""
    now = _now(site, tracker_id)
    if now is None:
        return
    moves = any(axis is not None and axis.moving for axis in (now.azimuth, now.elevation))
    (what,) = doing((now,)).values()
    against = against_another_aim if found.moves_target else against_other_settings
    if reason := against(tracker_id, what, is_moving=moves):
        raise CommandRejected(reason)


def _now(site: SiteSnapshot | None, tracker_id: str) -> Snapshot | None:
    trackers = () if site is None else site.trackers
    return next((one for one in trackers if one.tracker_id == tracker_id), None)


def limit_review(site: SiteSnapshot | None, tracker: TrackerDetail, wanted: TrackerConfig) -> LimitReview:
    """Return what saving would change of limits, speeds and aim, judged against where the axes stand now."""
    config = tracker.state.config
    now = _now(site, config.tracker_id)
    seen = {} if now is None else {Axis.AZIMUTH: now.azimuth, Axis.ELEVATION: now.elevation}
    stands: dict[Axis, Standing] = {axis: one for axis, one in seen.items() if one is not None}
    found = review(config, wanted, stands, trusted=tracker.state.memory.home is not None)
    aimed = aim_review(site, tracker.state, replace(tracker.state, config=wanted))
    return LimitReview(found.differences + aimed.differences, found.against, found.doubts + aimed.doubts)


def aim_review(site: SiteSnapshot | None, old: TrackerState, new: TrackerState) -> LimitReview:
    """Return what saving would change of the aim of a tracker that can track, and how far that moves it."""
    now = _now(site, old.config.tracker_id)
    if site is None or now is None:
        return LimitReview()
    stands_deg = None if now.azimuth is None else now.azimuth.position_deg
    return target_review(old, new, site.location, site.at, stands_deg)


async def must_ask(request: Request, tracker_id: str, found: LimitReview) -> bool:
    """Return whether somebody has to be sure of these differences before they are saved.

    Raises `CommandRejected` where that would be in vain: the tracker moves, or may do so by itself.
    """
    if not found.doubts or (await request.form()).get(CONFIRMED) == found.digest:
        return False
    _refuse_before_asking(panel(request).machine.latest(), tracker_id, found)
    return True


def require_proof(request: Request, config: TrackerConfig, wanted: TrackerConfig) -> None:
    """Raise `ProofNeeded` where limits, speeds or the drive change and the password was not typed just now.

    Other settings of the same form or call need no password.
    """
    who = principal(request)
    if who.via is not Via.SESSION or is_proven(who.proven_at, panel(request).clock.now()):
        return
    if config.drive != wanted.drive or review(config, wanted, {}, trusted=True).differences:
        raise ProofNeeded(N_("Limits, speeds, and the drive are sensitive settings: they were not saved."))
