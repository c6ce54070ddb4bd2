"""What a tracker can be asked to do, and the sentences that say why it will not."""

from dataclasses import dataclass
from datetime import timedelta
from typing import Annotated, ClassVar, Literal

from app.base.errors import WRONG, Foreseen
from app.base.message import join
from app.base.permission import Permission
from app.tracker.memory.drive_tests import StopSpeed
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import StowName
from app.tracker.values.mode import Mode
from app.tracker.values.order_spec import Interface, Motion, OrderSpec, Value
from app.tracker.values.reason import Reason

JOG_LEASE = timedelta(milliseconds=240)
WHO = Value(told="Who works there.", shortest=1, longest=60, examples=("Ada",))


class CommandRejected(Foreseen):
    """The tracker will not do this now; `reasons` lists every unmet condition."""

    exit_code = WRONG

    def __init__(self, *reasons: Reason) -> None:
        super().__init__(join(" ", (reason.message for reason in reasons)))
        self.reasons = reasons


@dataclass(frozen=True, slots=True)
class Jog:
    """Turn one axis while the lease is renewed: the same `press_id` renews, a press that ended stays dead.

    `lease` is at most `JOG_LEASE`; `sequence` grows with every renewal of a press, which begins with 0 or 1:
    an unknown press with a higher one is the rest of a press that ended.
    """

    press_id: str
    axis: Axis
    direction: Literal[-1, 1]
    speed: JogSpeed = JogSpeed.SLOW
    sequence: int = 0
    lease: timedelta = JOG_LEASE
    kind: Literal["jog"] = "jog"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS, held=True)


@dataclass(frozen=True, slots=True)
class EndJog:
    """The key was let go: stop, and never obey this press again."""

    press_id: str
    kind: Literal["end_jog"] = "end_jog"
    spec: ClassVar = OrderSpec(needs=Permission.STOP, motion=Motion.ENDS, held=True, control=False)


@dataclass(frozen=True, slots=True)
class Step:
    """Move one axis by a small increment, signed."""

    axis: Axis
    delta_deg: Annotated[float, Value(least=-5, most=5, told="0.1, 1 or 5 degrees; azimuth grows eastwards.")]
    kind: Literal["step"] = "step"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class UndoHome:
    """Bring back the home position as it was before it was set last; refused once the axes have moved."""

    kind: Literal["undo_home"] = "undo_home"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE)


@dataclass(frozen=True, slots=True)
class SetHome:
    """Here the axes point to north and the horizon: call this zero."""

    axes: tuple[Axis, ...] = (Axis.AZIMUTH, Axis.ELEVATION)
    kind: Literal["set_home"] = "set_home"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, undone_by=UndoHome)


@dataclass(frozen=True, slots=True)
class Home:
    """Search the origin switches, on drives that have them."""

    kind: Literal["home"] = "home"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, motion=Motion.BEGINS, by=Interface.EVERY)


@dataclass(frozen=True, slots=True)
class SelectMode:
    """Choose what tracking will do; the orientation counts for the axes that are held."""

    mode: Mode
    orientation: Orientation | None = None
    kind: Literal["set_mode"] = "set_mode"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE)


@dataclass(frozen=True, slots=True)
class Move:
    """Go to an orientation and stay there."""

    orientation: Orientation
    kind: Literal["move"] = "move"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS, by=Interface.EVERY)


@dataclass(frozen=True, slots=True)
class Park:
    """Go to the park position and stay there."""

    kind: Literal["park"] = "park"
    spec: ClassVar = OrderSpec(
        needs=Permission.OPERATE, motion=Motion.BEGINS, by=Interface.PEOPLE | Interface.MQTT
    )


@dataclass(frozen=True, slots=True)
class Stow:
    """Go to a stow position and stay there until `resume`; tracking that is on waits meanwhile."""

    position: StowName
    kind: Literal["stow"] = "stow"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class Resume:
    """Leave the stow position that was commanded; tracking goes on if it was on."""

    kind: Literal["resume"] = "resume"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class SetInhibit:
    """Somebody works on the machine: forbid every automatic motion, stows included."""

    name: Annotated[str, WHO]
    reason: Annotated[str, Value(longest=200)] = ""
    kind: Literal["set_inhibit"] = "set_inhibit"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, control=False)


@dataclass(frozen=True, slots=True)
class ReleaseInhibit:
    """Nobody works on the machine any more; nothing moves because of it."""

    kind: Literal["release_inhibit"] = "release_inhibit"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, control=False)


@dataclass(frozen=True, slots=True)
class Track:
    """Follow the selected mode from now on, also after a restart."""

    kind: Literal["track"] = "track"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS, by=Interface.EVERY)


@dataclass(frozen=True, slots=True)
class GoToStart:
    """Move to where the panel stands at the start of a show."""

    plan: ShowPlan
    kind: Literal["go_to_start"] = "go_to_start"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class RunShow:
    """Run the show; the panel must stand at its start position."""

    plan: ShowPlan
    kind: Literal["run_show"] = "run_show"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class PauseShow:
    """Hold the show where it is."""

    kind: Literal["pause_show"] = "pause_show"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE)


@dataclass(frozen=True, slots=True)
class ResumeShow:
    """Go on with a paused show."""

    kind: Literal["resume_show"] = "resume_show"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class StopShow:
    """End the show before its time; the panel stays where it is."""

    kind: Literal["stop_show"] = "stop_show"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE)


@dataclass(frozen=True, slots=True)
class RunDirectionTest:
    """Turn one axis by 3 degrees, so that somebody can see which way the panel goes."""

    axis: Axis
    kind: Literal["test_direction"] = "test_direction"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class RunScaleTest:
    """Turn one axis by 10, 30 or 90 degrees, so that somebody can measure by how much the panel turned."""

    axis: Axis
    delta_deg: Annotated[float, Value(choices=(10, 30, 90))] = 10.0
    kind: Literal["test_scale"] = "test_scale"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class RunStopTest:
    """Bring one axis up to speed, stop it, and measure time and way until it stands."""

    axis: Axis
    speed: StopSpeed
    kind: Literal["test_stop"] = "test_stop"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class RunCommunicationLossTest:
    """Move one axis slowly, then send the drive nothing, and measure what it does by itself."""

    axis: Axis
    kind: Literal["test_communication_loss"] = "test_communication_loss"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, motion=Motion.BEGINS)


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop both axes now and switch tracking off. Needs nothing, is never refused, resumes nothing."""

    kind: Literal["stop"] = "stop"
    spec: ClassVar = OrderSpec(
        needs=Permission.STOP, by=Interface.EVERY, motion=Motion.STOPS, control=False, in_safe_mode=True
    )


@dataclass(frozen=True, slots=True)
class ResetFault:
    """The cause is removed: clear the fault and hold."""

    kind: Literal["reset_fault"] = "reset_fault"
    spec: ClassVar = OrderSpec(needs=Permission.OPERATE, by=Interface.PEOPLE | Interface.MQTT)


@dataclass(frozen=True, slots=True)
class BeginServiceMode:
    """Serve the machine: stop, then move at the slow hand speed and only while the area is clear."""

    name: Annotated[str, WHO]
    kind: Literal["begin_service_mode"] = "begin_service_mode"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, control=False)


@dataclass(frozen=True, slots=True)
class ConfirmAreaClear:
    """Nobody stands where the panel moves; in service mode that allows motion for a while."""

    kind: Literal["confirm_area_clear"] = "confirm_area_clear"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, control=False)


@dataclass(frozen=True, slots=True)
class EndServiceMode:
    """Leave service mode; nothing moves because of it."""

    kind: Literal["end_service_mode"] = "end_service_mode"
    spec: ClassVar = OrderSpec(needs=Permission.CONFIGURE, control=False)


Command = (
    Jog | EndJog | Step | SetHome | UndoHome | Home | SelectMode | Move | Park | Track
    | GoToStart | RunShow | PauseShow | ResumeShow | StopShow | Stop | ResetFault
    | RunDirectionTest | RunScaleTest | RunStopTest | RunCommunicationLossTest
    | Stow | Resume | SetInhibit | ReleaseInhibit
    | BeginServiceMode | ConfirmAreaClear | EndServiceMode
)  # fmt: skip
