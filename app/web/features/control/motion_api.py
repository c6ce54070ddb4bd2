"""What makes a tracker move, and what stops it."""

from typing import TYPE_CHECKING, Annotated, Literal, Union, get_args

from pydantic import Field

from app.base.instants import Instant
from app.base.message import N_, join
from app.base.permission import Permission
from app.link.messages import Machine, StopAll
from app.link.order_models import OrderModel, order_model
from app.tracker.commands.commands import (
    Command,
    EndJog,
    GoToStart,
    Jog,
    PauseShow,
    ResumeShow,
    RunShow,
    SelectMode,
    SetHome,
    Stop,
    StopShow,
)
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.tracker.values.mode import Mode
from app.tracker.values.order_spec import Interface
from app.web.api.base import NOT_FOUND, REFUSED, Azimuth, Elevation, Input, TrackerId, api_router
from app.web.api.orders import SenderDep, listed, tracker_of
from app.web.api.trackers import detail_of
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, SnapshotDep
from app.web.shell.zero import JUMP_DEG, zero_doubts

router = api_router(tags=["motion"])

PressId = Annotated[
    str, Field(min_length=1, max_length=64, description="New for every press of the key.", examples=["p-1"])
]


class _Request(Input):
    issued_at: Instant | None = Field(
        None,
        description="When this was asked, by the site's clock; refused when more than 2 s old or ahead.",
    )


class CommandRequest(_Request, OrderModel):
    """What every command carries."""

    def command_from(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return self.command()


class SetHomeCommand(CommandRequest):
    """Here the axes point to north and the horizon: call this zero."""

    order = SetHome
    type: Literal["set_home"]
    axes: tuple[Axis, ...] = Field((Axis.AZIMUTH, Axis.ELEVATION), min_length=1, max_length=2)
    confirmed: bool = Field(
        False,
        description=f"The panel really is there although the drive reads more than {JUMP_DEG:g} degrees.",
    )

    def command(self) -> Command:
        """Return what the machine is asked."""
        return SetHome(tuple(dict.fromkeys(self.axes)))


class SetModeCommand(CommandRequest):
    """Choose what tracking does; the angles count for the axes that it holds, left out they stay."""

    order = SelectMode
    type: Literal["set_mode"]
    mode: Mode
    azimuth_deg: Azimuth | None = None
    elevation_deg: Elevation | None = None

    def command_from(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        azimuth_deg = held.azimuth_deg if self.azimuth_deg is None else self.azimuth_deg
        elevation_deg = held.elevation_deg if self.elevation_deg is None else self.elevation_deg
        return SelectMode(self.mode, Orientation(azimuth_deg, elevation_deg))


OWN_ROUTE = (Jog, EndJog, Stop, GoToStart, RunShow, PauseShow, ResumeShow, StopShow)
"""What is not sent as a command: each has a route of its own."""
SAYS_MORE = {SetHome: SetHomeCommand, SelectMode: SetModeCommand}
"""Commands of which a program says another thing than the machine hears."""

if TYPE_CHECKING:
    AnyCommand = CommandRequest
else:
    _models = tuple(
        SAYS_MORE.get(one) or order_model(one, CommandRequest)
        for one in get_args(Command)
        if Interface.API in one.spec.by and one not in OWN_ROUTE
    )
    AnyCommand = Annotated[Union[_models], Field(discriminator="type")]  # noqa: UP007


class JogRequest(_Request):
    """Turn one axis for at most the lease; the same press with a growing sequence renews it."""

    press_id: PressId
    axis: Axis
    direction: Literal[-1, 1] = Field(description="1: east or up, -1: west or down.")
    speed: JogSpeed = JogSpeed.SLOW
    sequence: int = Field(0, ge=0, le=2**53, description="Grows with every renewal of a press.")


@router.post("/trackers/{tracker_id}/stop", status_code=202, summary="Stop now", responses=NOT_FOUND)
@needs(Permission.STOP)
async def stop_tracker(tracker_id: TrackerId, sender: SenderDep) -> Snapshot:
    """Stop both axes at once and switch tracking off; never refused, needs no body, resumes nothing."""
    return await sender.command(tracker_id, Stop())


@router.post("/stop", status_code=202, summary="Stop every tracker now")
@needs(Permission.STOP)
async def stop_all(sender: SenderDep) -> SiteSnapshot:
    """Stop every tracker of the site at once."""
    return listed(await sender.send(StopAll()))


@router.post(
    "/trackers/{tracker_id}/jog", status_code=202, summary="Hold to run", responses=NOT_FOUND | REFUSED
)
@needs(Permission.OPERATE)
async def jog_axis(tracker_id: TrackerId, request: JogRequest, sender: SenderDep) -> Snapshot:
    """Move for at most 240 ms unless renewed; a press that has ended is dead for ever."""
    command = Jog(request.press_id, request.axis, request.direction, request.speed, request.sequence)
    return await sender.command(tracker_id, command, request.issued_at)


@router.delete(
    "/trackers/{tracker_id}/jog/{press_id}", status_code=202, summary="Let go", responses=NOT_FOUND | REFUSED
)
@needs(Permission.STOP)
async def end_jog(tracker_id: TrackerId, press_id: str, sender: SenderDep) -> Snapshot:
    """Stop the axis of this press and never obey the press again."""
    return await sender.command(tracker_id, EndJog(press_id))


@router.post(
    "/trackers/{tracker_id}/commands", status_code=202, summary="Command", responses=NOT_FOUND | REFUSED
)
@needs(Permission.OPERATE)
async def send_command(
    tracker_id: TrackerId, request: AnyCommand, sender: SenderDep, site: SnapshotDep, machine: MachineDep
) -> Snapshot:
    """Start what is asked; `activity` and `in_position` of the snapshot tell when it is done.

    `zero` where the drive reads another angle is refused with the question until it is `confirmed`.
    """
    tracker = tracker_of(site, tracker_id)
    if isinstance(request, SetHomeCommand) and not request.confirmed:
        await _ask(machine, tracker, request)
    held = tracker.orientation
    return await sender.command(tracker_id, request.command_from(held), request.issued_at)


async def _ask(machine: Machine, tracker: Snapshot, request: SetHomeCommand) -> None:
    mount = (await detail_of(machine, tracker.tracker_id)).state.config.mount
    if doubts := zero_doubts(mount, tracker, request.axes):
        raise NotAcceptable(
            join(
                " ",
                (
                    *doubts,
                    N_("If the panel is at the home position, send the request again with `confirmed`."),
                ),
            )
        )
