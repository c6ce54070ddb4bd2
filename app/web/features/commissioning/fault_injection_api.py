"""Training: faults played on a simulated tracker."""

from pydantic import Field

from app.base.permission import Permission
from app.link.messages import EndInjectedFaults, InjectFault
from app.tracker.programs.fault_scenarios import LESSONS, Lesson
from app.web.api.base import NOT_FOUND, REFUSED, Input, Page, TrackerId, api_router, whole
from app.web.api.orders import SenderDep
from app.web.http.needs import needs

router = api_router(prefix="/trackers/{tracker_id}/fault-injection", tags=["training"])


class PlayedFault(Input):
    """A fault of the list of lessons."""

    fault: str = Field(min_length=1, max_length=40, examples=["stall"])


@router.get("", summary="The faults that can be played", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_faults(tracker_id: TrackerId) -> Page[Lesson]:
    """Return each fault with what will be seen and what to do."""
    return whole(LESSONS)


@router.post("", status_code=204, summary="Inject a fault", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def inject_fault(tracker_id: TrackerId, played: PlayedFault, sender: SenderDep) -> None:
    """Inject a fault on a tracker that this program simulates; refused on a real one."""
    await sender.send(InjectFault(tracker_id, played.fault))


@router.delete("", status_code=204, summary="End all faults", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def end_injected_faults(tracker_id: TrackerId, sender: SenderDep) -> None:
    """End every fault that is played; what the controller has latched stays for the operator."""
    await sender.send(EndInjectedFaults(tracker_id))
