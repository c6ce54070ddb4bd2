"""Before limits or speeds are saved: what differs, where the axes stand, and what to be sure of."""

from starlette.requests import Request

from app.access.principal import ProofNeeded, Via
from app.access.sessions import is_proven
from app.base.message import N_
from app.link.messages import TrackerDetail
from app.tracker.motion.limit_change import LimitReview, Standing, review
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import SiteSnapshot
from app.web.shell.deps import panel, principal

CONFIRMED = "confirmed"
"""The field that holds the differences which somebody was sure of; others are asked for again."""


def limit_review(site: SiteSnapshot | None, tracker: TrackerDetail, wanted: TrackerConfig) -> LimitReview:
    """Return what saving would change of limits and speeds, judged against where the axes stand now."""
    config = tracker.state.config
    trackers = () if site is None else site.trackers
    now = next((one for one in trackers if one.tracker_id == config.tracker_id), None)
    seen = {} if now is None else {Axis.AZIMUTH: now.azimuth, Axis.ELEVATION: now.elevation}
    stands: dict[Axis, Standing] = {axis: one for axis, one in seen.items() if one is not None}
    return review(config, wanted, stands, trusted=tracker.state.memory.home is not None)


async def must_ask(request: Request, found: LimitReview) -> bool:
    """Return whether somebody has to be sure of these differences before they are saved."""
    return bool(found.doubts) and (await request.form()).get(CONFIRMED) != found.digest


def require_proof(request: Request, config: TrackerConfig, wanted: TrackerConfig) -> None:
    """Raise `ProofNeeded` where limits, speeds or the drive change and the password was not typed just now.

    Other settings of the same form or call need no password.
    """
    who = principal(request)
    if who.via is not Via.SESSION or is_proven(who.proven_at, panel(request).clock.now()):
        return
    if config.drive != wanted.drive or review(config, wanted, {}, trusted=True).differences:
        raise ProofNeeded(N_("Limits, speeds, and the drive are sensitive settings: they were not saved."))
