"""Who has control of a tracker; to ask for it, take it over, hand it over, keep it or let go of it."""

from enum import StrEnum
from typing import Annotated

from pydantic import Field

from app.base.permission import Permission
from app.link.messages import AnswerControl, ReleaseControl, RequestControl, SiteCommand
from app.tracker.commands.control import ControlState
from app.tracker.state.snapshot import SiteSnapshot
from app.web.api.base import NOT_FOUND, REFUSED, Input, Output, Page, TrackerId, api_router, whole
from app.web.api.orders import SenderDep, tracker_of
from app.web.http.needs import needs
from app.web.shell.deps import PrincipalDep, SnapshotDep

router = api_router(tags=["control"])


class ControlAction(StrEnum):
    """What is said about control."""

    REQUEST = "request"
    TAKE_OVER = "take_over"
    HAND_OVER = "hand_over"
    KEEP = "keep"


class ControlInput(Input):
    """What is said about control of one tracker."""

    action: ControlAction = Field(
        ControlAction.REQUEST,
        description="`request` takes what is free, renews what one has, and asks whoever has it; `take_over` "
        "gives them 10 s to refuse, and needs a reason; `hand_over` and `keep` answer such a wish.",
    )
    reason: str = Field("", max_length=200, description="Why; everyone reads it.", examples=["Cleaning"])

    def command(self, tracker_id: str) -> SiteCommand:
        """Return what the machine is asked."""
        match self.action:
            case ControlAction.REQUEST | ControlAction.TAKE_OVER:
                takes = self.action is ControlAction.TAKE_OVER
                return RequestControl((tracker_id,), takes, self.reason)
            case ControlAction.HAND_OVER | ControlAction.KEEP:
                return AnswerControl(tracker_id, self.action is ControlAction.HAND_OVER)


class GroupInput(Input):
    """Control of several trackers at once: of all of them, or of none."""

    tracker_ids: tuple[Annotated[str, Field(min_length=1, max_length=64)], ...] = Field(
        min_length=1, max_length=500, description="The trackers.", examples=[["T1", "T2"]]
    )
    reason: str = Field("", max_length=200, description="Why; everyone reads it.")


class ControlOutput(Output):
    """Who has control of one tracker, and whether that is the caller."""

    tracker_id: str = Field(description="The tracker.")
    yours: bool = Field(description="Whether the caller has control.")
    control: ControlState = Field(
        description="Who has it, until when, and who wants it. `epoch` belongs into the header "
        "`Control-Epoch` of orders for motion: when control has changed since, they are refused."
    )


def _output(site: SiteSnapshot, tracker_id: str, who: PrincipalDep) -> ControlOutput:
    control = tracker_of(site, tracker_id).control
    yours = (control.holder, control.via) == (who.actor, who.via.value)
    return ControlOutput(tracker_id=tracker_id, yours=yours, control=control)


@router.get(
    "/trackers/{tracker_id}/control",
    summary="Who has control of a tracker",
    responses=NOT_FOUND,
)
@needs(Permission.READ)
async def read_control(tracker_id: TrackerId, site: SnapshotDep, who: PrincipalDep) -> ControlOutput:
    """Return who has control; reading never needs it."""
    return _output(site, tracker_id, who)


@router.post(
    "/trackers/{tracker_id}/control",
    summary="Ask for control, take it over, hand it over or keep it",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.OPERATE)
async def change_control(
    tracker_id: TrackerId, said: ControlInput, sender: SenderDep, who: PrincipalDep
) -> ControlOutput:
    """Carry out what is said about control. Motion that somebody else ordered stops before control passes."""
    return _output(await sender.send(said.command(tracker_id)), tracker_id, who)


@router.delete(
    "/trackers/{tracker_id}/control",
    summary="Let go of control",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.OPERATE)
async def release_control(tracker_id: TrackerId, sender: SenderDep, who: PrincipalDep) -> ControlOutput:
    """Let go of control: whoever wants it has it, else nobody. Tracking and shows go on."""
    return _output(await sender.send(ReleaseControl(tracker_id)), tracker_id, who)


@router.post(
    "/control",
    summary="Take control of several trackers, of all or of none",
    responses=NOT_FOUND | REFUSED,
)
@needs(Permission.OPERATE)
async def request_control_of_group(
    said: GroupInput, sender: SenderDep, who: PrincipalDep
) -> Page[ControlOutput]:
    """Take control of all of these trackers, in the order of their ids, or say who has one of them."""
    ids = tuple(sorted(set(said.tracker_ids)))
    site = await sender.send(RequestControl(ids, reason=said.reason))
    return whole(_output(site, tracker_id, who) for tracker_id in ids)
