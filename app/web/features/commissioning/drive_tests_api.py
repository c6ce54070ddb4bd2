"""What was proven about a tracker's drive, and what somebody at the machine says about it."""

from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from app.base.adapter import adapter
from app.base.message import say
from app.base.permission import Permission
from app.link.messages import AnswerDirection, AnswerScale, CheckConnection, RestoreDrive, SetSoftLimit
from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.memory.drive_check import DriveCheck, DriveChoices
from app.tracker.memory.drive_tests import AxisEnd, Proofs
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import DriveConfig, TrackerConfig
from app.web.api.base import NOT_FOUND, REFUSED, Input, Output, TrackerId, api_router
from app.web.api.changes import Change, change_of, given
from app.web.api.orders import SenderDep
from app.web.api.trackers import detail_of, merged
from app.web.http.errors import NotFound
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep

router = api_router(prefix="/trackers/{tracker_id}", tags=["drive"])


if TYPE_CHECKING:
    DriveChange = Change
else:
    DriveChange = change_of(DriveConfig)


class DriveProofs(Output):
    """Where every proof stands, and all that was measured."""

    states: tuple[ProofState, ...] = Field(
        description="Each proof: to do, to be confirmed (a later change made it untrue) or done, and why."
    )
    measured: Proofs = Field(description="The newest of each sort; `move` waits to be judged.")


class SeenDirection(Input):
    """What somebody saw after `test_direction`."""

    right: bool = Field(description="True: the panel turned as the sign of `measured.move` says.")


class MeasuredAngle(Input):
    """What somebody measured after `test_scale`."""

    measured_deg: Annotated[float, Field(gt=0, le=720, description="Degrees, without a sign.")]


class TakenLimit(Input):
    """The axis stands where this soft limit shall be."""

    axis: Axis
    end: AxisEnd


@router.get("/drive-tests", summary="Results of the drive tests", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_drive_tests(tracker_id: TrackerId, machine: MachineDep) -> DriveProofs:
    """Return every proof; they begin with a command of type `prove_...` or `measure_...`."""
    tracker = await detail_of(machine, tracker_id)
    return DriveProofs(states=tracker.proofs, measured=tracker.state.memory.proofs)


@router.post("/drive-tests/direction", summary="Say which way it went", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def answer_direction_test(
    tracker_id: TrackerId, seen: SeenDirection, sender: SenderDep, machine: MachineDep
) -> DriveProofs:
    """Keep that the direction is right, or turn it round in the settings: then prove it again."""
    await sender.send(AnswerDirection(tracker_id, seen.right))
    return await read_drive_tests(tracker_id, machine)


@router.post("/drive-tests/scale", summary="Say how far it went", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def answer_scale_test(
    tracker_id: TrackerId, measured: MeasuredAngle, sender: SenderDep, machine: MachineDep
) -> DriveProofs:
    """Keep that the scale is right (within 0.2 degrees), or correct the gear ratio: then prove it again."""
    await sender.send(AnswerScale(tracker_id, measured.measured_deg))
    return await read_drive_tests(tracker_id, machine)


@router.post("/drive-tests/limits", summary="Take a soft limit here", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def set_soft_limit(
    tracker_id: TrackerId, taken: TakenLimit, sender: SenderDep, machine: MachineDep
) -> DriveProofs:
    """Take the place where the axis stands as its lower or upper soft limit."""
    await sender.send(SetSoftLimit(tracker_id, taken.axis, taken.end))
    return await read_drive_tests(tracker_id, machine)


@router.get("/drive/choices", summary="Profiles and serial ports", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_choices(tracker_id: TrackerId, machine: MachineDep) -> DriveChoices:
    """Return the profiles that can be chosen, verified or not, and the machine's serial ports."""
    await detail_of(machine, tracker_id)
    return (await machine.detail()).choices


@router.get("/drive/check", summary="The newest look at the drive", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_check(tracker_id: TrackerId, machine: MachineDep) -> DriveCheck:
    """Return what the drive answered when its connection was tested last."""
    check = (await detail_of(machine, tracker_id)).check
    if check is None:
        raise NotFound(
            say("The connection to the drive of {tracker_id} has not been tested yet.", tracker_id=tracker_id)
        )
    return check


@router.post("/drive/check", summary="Test the connection", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE)
async def check_drive(
    tracker_id: TrackerId, change: DriveChange, sender: SenderDep, machine: MachineDep
) -> DriveCheck:
    """Read every register of the drive with these settings (left out: as set); nothing is changed."""
    config = (await detail_of(machine, tracker_id)).state.config
    wanted = _changed(config.drive, change)
    await sender.send(CheckConnection(tracker_id, wanted))
    return await read_check(tracker_id, machine)


@router.post("/drive/undo", summary="Undo the last change of the drive", responses=NOT_FOUND | REFUSED)
@needs(Permission.CONFIGURE, proven=True)
async def restore_drive(tracker_id: TrackerId, sender: SenderDep, machine: MachineDep) -> TrackerConfig:
    """Set the drive as it was before its settings were changed last; once more goes forth again."""
    await sender.send(RestoreDrive(tracker_id))
    return (await detail_of(machine, tracker_id)).state.config


def _changed(drive: DriveConfig, change: Change) -> DriveConfig:
    return adapter(DriveConfig).validate_python(
        merged(adapter(DriveConfig).dump_python(drive, mode="json"), given(change))
    )
