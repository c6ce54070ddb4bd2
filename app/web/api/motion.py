"""What makes a tracker move, and what stops it."""

from typing import Annotated, Literal

from pydantic import Field

from app.instants import Instant
from app.link.messages import Machine, StopAll
from app.tracker.axes import Axis, JogSpeed
from app.tracker.commands import (
    BeginServiceMode,
    Command,
    ConfirmAreaClear,
    EndJog,
    EndServiceMode,
    Home,
    Jog,
    Move,
    Park,
    ReleaseInhibit,
    ResetFault,
    Resume,
    RunCommunicationLossTest,
    RunDirectionTest,
    RunScaleTest,
    RunStopTest,
    SelectMode,
    SetHome,
    SetInhibit,
    Step,
    Stop,
    Stow,
    Track,
    UndoHome,
)
from app.tracker.config import Orientation
from app.tracker.drive_tests import StopSpeed
from app.tracker.mode import Mode
from app.tracker.protections.words import StowName
from app.tracker.snapshot import SiteSnapshot, Snapshot
from app.web.api.base import NOT_FOUND, REFUSED, Azimuth, Elevation, Input, TrackerId, api_router
from app.web.api.orders import SenderDep, listed, tracker_of
from app.web.api.trackers import detail_of
from app.web.deps import MachineDep, SnapshotDep
from app.web.errors import NotAcceptable
from app.web.zero import JUMP_DEG, zero_doubts

router = api_router(tags=["motion"])

PressId = Annotated[
    str, Field(min_length=1, max_length=64, description="New for every press of the key.", examples=["p-1"])
]


class _Command(Input):
    issued_at: Instant | None = Field(
        None,
        description="When this was asked, by the site's clock; refused when more than 2 s old or ahead.",
    )


class MoveCommand(_Command):
    """Go to an orientation and stay there."""

    type: Literal["move"]
    azimuth_deg: Azimuth
    elevation_deg: Elevation

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Move(Orientation(self.azimuth_deg, self.elevation_deg))


class StepCommand(_Command):
    """Move one axis by a small increment, signed."""

    type: Literal["step"]
    axis: Axis
    degrees: float = Field(ge=-5, le=5, description="0.1, 1 or 5 degrees; azimuth grows eastwards.")

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Step(self.axis, self.degrees)


class SetHomeCommand(_Command):
    """Here the axes point to north and the horizon: call this zero."""

    type: Literal["set_home"]
    axes: tuple[Axis, ...] = Field((Axis.AZIMUTH, Axis.ELEVATION), min_length=1, max_length=2)
    confirmed: bool = Field(
        False,
        description=f"The panel really is there although the drive reads more than {JUMP_DEG:g} degrees.",
    )

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return SetHome(tuple(dict.fromkeys(self.axes)))


class UndoHomeCommand(_Command):
    """Bring back the home position as it was before it was set last; refused once the axes have moved."""

    type: Literal["undo_home"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return UndoHome()


class HomeCommand(_Command):
    """Search the origin switches, on drives that have them."""

    type: Literal["home"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Home()


class ModeCommand(_Command):
    """Choose what tracking does; the angles count for the axes that it holds, left out they stay."""

    type: Literal["set_mode"]
    mode: Mode
    azimuth_deg: Azimuth | None = None
    elevation_deg: Elevation | None = None

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        azimuth_deg = held.azimuth_deg if self.azimuth_deg is None else self.azimuth_deg
        elevation_deg = held.elevation_deg if self.elevation_deg is None else self.elevation_deg
        return SelectMode(self.mode, Orientation(azimuth_deg, elevation_deg))


class TrackCommand(_Command):
    """Follow the selected mode from now on, also after a restart."""

    type: Literal["track"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Track()


class ParkCommand(_Command):
    """Go to the park position and stay there."""

    type: Literal["park"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Park()


class StowCommand(_Command):
    """Go to a stow position and stay there until `resume`; tracking that is on waits meanwhile."""

    type: Literal["stow"]
    position: StowName

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Stow(self.position)


class ResumeCommand(_Command):
    """Leave the stow position that was commanded; tracking goes on if it was on."""

    type: Literal["resume"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return Resume()


class LockOutCommand(_Command):
    """Somebody works on the machine: forbid every automatic motion, stows included."""

    type: Literal["set_inhibit"]
    name: str = Field(min_length=1, max_length=60, description="Who works there.", examples=["Ada"])
    reason: str = Field("", max_length=200)

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return SetInhibit(self.name, self.reason)


class ReleaseLockCommand(_Command):
    """Nobody works on the machine any more; nothing moves because of it."""

    type: Literal["release_inhibit"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return ReleaseInhibit()


class BeginServiceCommand(_Command):
    """Serve the machine: stop, then move at the slow hand speed and only while the area is clear."""

    type: Literal["begin_service_mode"]
    name: str = Field(min_length=1, max_length=60, description="Who works there.", examples=["Ada"])

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return BeginServiceMode(self.name)


class ConfirmClearCommand(_Command):
    """Nobody stands where the panel moves; in service mode that allows motion for a while."""

    type: Literal["confirm_area_clear"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return ConfirmAreaClear()


class EndServiceCommand(_Command):
    """Leave service mode; nothing moves because of it."""

    type: Literal["end_service_mode"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return EndServiceMode()


class ResetFaultCommand(_Command):
    """The cause is removed: clear the fault and hold."""

    type: Literal["reset_fault"]

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return ResetFault()


class ProveDirectionCommand(_Command):
    """Turn one axis by 3 degrees, so that somebody can see which way the panel goes."""

    type: Literal["test_direction"]
    axis: Axis

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return RunDirectionTest(self.axis)


class ProveScaleCommand(_Command):
    """Turn one axis by 10, 30 or 90 degrees, so that somebody can measure by how much the panel turned."""

    type: Literal["test_scale"]
    axis: Axis
    degrees: Literal[10, 30, 90] = 10

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return RunScaleTest(self.axis, float(self.degrees))


class MeasureStopCommand(_Command):
    """Bring one axis up to speed, stop it, and measure time and way until it stands."""

    type: Literal["test_stop"]
    axis: Axis
    speed: StopSpeed

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return RunStopTest(self.axis, self.speed)


class MeasureLinkLossCommand(_Command):
    """Move one axis slowly, then send the drive nothing, and measure what it does by itself."""

    type: Literal["test_communication_loss"]
    axis: Axis

    def command(self, held: Orientation) -> Command:
        """Return what the machine is asked; `held` is the orientation that is set now."""
        return RunCommunicationLossTest(self.axis)


AnyCommand = Annotated[
    MoveCommand
    | StepCommand
    | SetHomeCommand
    | UndoHomeCommand
    | HomeCommand
    | ModeCommand
    | TrackCommand
    | ParkCommand
    | StowCommand
    | ResumeCommand
    | LockOutCommand
    | ReleaseLockCommand
    | BeginServiceCommand
    | ConfirmClearCommand
    | EndServiceCommand
    | ResetFaultCommand
    | ProveDirectionCommand
    | ProveScaleCommand
    | MeasureStopCommand
    | MeasureLinkLossCommand,
    Field(discriminator="type"),
]


class JogRequest(_Command):
    """Turn one axis for at most the lease; the same press with a growing sequence renews it."""

    press_id: PressId
    axis: Axis
    direction: Literal[-1, 1] = Field(description="1: east or up, -1: west or down.")
    speed: JogSpeed = JogSpeed.SLOW
    sequence: int = Field(0, ge=0, le=2**53, description="Grows with every renewal of a press.")


@router.post("/trackers/{tracker_id}/stop", status_code=202, summary="Stop now", responses=NOT_FOUND)
async def stop_tracker(tracker_id: TrackerId, sender: SenderDep) -> Snapshot:
    """Stop both axes at once and switch tracking off; never refused, needs no body, resumes nothing."""
    return await sender.command(tracker_id, Stop())


@router.post("/stop", status_code=202, summary="Stop every tracker now")
async def stop_all(sender: SenderDep) -> SiteSnapshot:
    """Stop every tracker of the site at once."""
    return listed(await sender.send(StopAll()))


@router.post(
    "/trackers/{tracker_id}/jog", status_code=202, summary="Hold to run", responses=NOT_FOUND | REFUSED
)
async def jog_axis(tracker_id: TrackerId, request: JogRequest, sender: SenderDep) -> Snapshot:
    """Move for at most 240 ms unless renewed; a press that has ended is dead for ever."""
    command = Jog(request.press_id, request.axis, request.direction, request.speed, request.sequence)
    return await sender.command(tracker_id, command, request.issued_at)


@router.delete(
    "/trackers/{tracker_id}/jog/{press_id}", status_code=202, summary="Let go", responses=NOT_FOUND | REFUSED
)
async def end_jog(tracker_id: TrackerId, press_id: str, sender: SenderDep) -> Snapshot:
    """Stop the axis of this press and never obey the press again."""
    return await sender.command(tracker_id, EndJog(press_id))


@router.post(
    "/trackers/{tracker_id}/commands", status_code=202, summary="Command", responses=NOT_FOUND | REFUSED
)
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
    return await sender.command(tracker_id, request.command(held), request.issued_at)


async def _ask(machine: Machine, tracker: Snapshot, request: SetHomeCommand) -> None:
    mount = (await detail_of(machine, tracker.tracker_id)).state.config.mount
    if doubts := zero_doubts(mount, tracker, request.axes):
        raise NotAcceptable(
            " ".join(
                (*doubts, ("If the panel is at the home position, send the request again with `confirmed`."))
            )
        )
