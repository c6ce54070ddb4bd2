"""What changes seldom about each tracker: made again only when something that it is made of has changed."""

from app.base.clock import give_way
from app.link.messages import TrackerDetail
from app.site.loop.loop import TrackerLoop
from app.site.state.model import SiteModel
from app.tracker.commissioning.drive_test_states import proof_states
from app.tracker.commissioning.steps import steps
from app.tracker.state.snapshot import ClockState

MOST_AT_ONCE = 20


class Details:
    """The details of a site's trackers; one that has not changed is the same object as before."""

    def __init__(self, model: SiteModel) -> None:
        self._model = model
        self._known: dict[str, tuple[object, TrackerDetail]] = {}

    async def all(self) -> dict[str, TrackerDetail]:
        """Return the details of every tracker; a tick never waits for all of them."""
        clock, found = self._model.timekeeper.state(), {}
        for number, (tracker_id, loop) in enumerate(tuple(self._model.loops.items()), 1):
            found[tracker_id] = self._of(tracker_id, loop, clock)
            if number % MOST_AT_ONCE == 0:
                await give_way()
        self._known = {name: one for name, one in self._known.items() if name in self._model.loops}
        return found

    def _of(self, tracker_id: str, loop: TrackerLoop, clock: ClockState) -> TrackerDetail:
        site, standing, check = self._model.state, loop.standing, self._model.checks.newest(tracker_id)
        config, memory, able = loop.config, loop.memory, loop.drive.capabilities
        made_of = (config, memory, able, site, clock.trusted, clock.reasons, standing, check)
        known = self._known.get(tracker_id)
        if known is None or known[0] != made_of:
            detail = TrackerDetail(
                loop.state,
                steps(site, memory, standing, clock),
                able,
                proof_states(config, memory, able),
                check,
            )
            if known is not None and known[1] == detail:
                detail = known[1]
            known = self._known[tracker_id] = made_of, detail
        return known[1]
