"""Training: faults played on a simulated tracker."""

from pydantic import Field

from app.link.messages import EndInjectedFaults, InjectFault
from app.tracker.fault_scenarios import LESSONS, Lesson
from app.web.api.base import NOT_FOUND, REFUSED, Input, TrackerId, api_router
from app.web.api.orders import SenderDep

router = api_router(prefix="/trackers/{tracker_id}/fault-injection", tags=["training"])


class PlayedFault(Input):
    """A fault of the list of lessons."""

    fault: str = Field(min_length=1, max_length=40, examples=["stall"])


@router.get("", summary="The faults that can be played", responses=NOT_FOUND)
async def read_faults(tracker_id: TrackerId) -> tuple[Lesson, ...]:
    """Return each fault with what will be seen and what to do."""
    return LESSONS


@router.post("", status_code=204, summary="Play a fault", responses=NOT_FOUND | REFUSED)
async def inject_fault(tracker_id: TrackerId, played: PlayedFault, sender: SenderDep) -> None:
    """Play a fault on a tracker that this program simulates; refused on a real one."""
    await sender.send(InjectFault(tracker_id, played.fault))


@router.delete("", status_code=204, summary="End all faults", responses=NOT_FOUND | REFUSED)
async def end_injected_faults(tracker_id: TrackerId, sender: SenderDep) -> None:
    """End every fault that is played; what the controller has latched stays for the operator."""
    await sender.send(EndInjectedFaults(tracker_id))
