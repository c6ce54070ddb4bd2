"""One tracker that lives in memory."""

from dataclasses import replace
from datetime import UTC, datetime, timedelta
from math import copysign

from app.base.angles import separation_deg
from app.base.message import N_, Word, join
from app.tracker.commands.commands import (
    JOG_LEASE,
    Command,
    CommandRejected,
    EndJog,
    GoToStart,
    Home,
    Jog,
    Move,
    Park,
    PauseShow,
    ResetFault,
    ResumeShow,
    RunShow,
    SelectMode,
    SetHome,
    Step,
    Stop,
    StopShow,
    Track,
    UndoHome,
)
from app.tracker.memory.drive_check import DriveCheck
from app.tracker.memory.memory import (
    HomeTrust,
    TrackerState,
)
from app.tracker.programs.show import ShowPlan
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import (
    ActivityName,
    AxisState,
    Event,
    EventKind,
    Pair,
    SensorState,
    ShowPhase,
    ShowProgress,
    Snapshot,
)
from app.tracker.values.mode import Mode
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.reason import Reason
from tests.fake_data import made_up_sun

ACTIONS = (
    "jog", "step", "set_home", "undo_home", "home", "set_mode", "move", "park", "track", "go_to_start",
    "run_show", "pause_show", "resume_show", "stop_show", "stop", "reset_fault",
)  # fmt: skip
STOP_FIRST = Reason("moving", "The tracker is moving.", "Stop it first.")
NO_SWITCHES = Reason("no_origin_switches", "This drive has no origin switches.", "Set the zero by hand.")
NO_FORMER_HOME = Reason("nothing_to_undo", "There is no former home position.", "")
NO_SHOW = Reason("no_show", "No show is under way.", "Plan a show and go to its start.")
BUSY = Reason("busy", "Somebody else is moving this axis.", "Wait until it stands.")
NOT_RENEWED = "The jog ended: the jog command was not renewed in time."
CAPABILITIES = DriveCapabilities(False, 0.5, False, True, "Simulated drive", verified=True)


class FakeTracker:
    """One tracker that is at once where it was told to be."""

    def __init__(self, state: TrackerState, position: Pair) -> None:
        self.config = state.config
        self.memory = state.memory
        self.position = position
        self.activity = ActivityName.TRACKING if state.memory.tracking_on else ActivityName.HOLDING
        self.approaching = False
        self.sensors: tuple[SensorState, ...] = ()
        self.show: tuple[ShowPlan, ShowPhase] | None = None
        self.shown = 0.4
        self.press: str | None = None
        self.held_until = datetime.max.replace(tzinfo=UTC)
        self.dead: set[str] = set()
        self.sequence = -1
        self.not_stowed: Reason | None = None
        self.check: DriveCheck | None = None
        self.before_zero: tuple[Pair, HomeTrust | None] | None = None

    def handle(self, command: Command, now: datetime, actor: str) -> None:  # noqa: C901 - one flat table of cases
        """Do what was asked, at once."""
        match command:
            case Jog():
                self._jog(command, now)
            case EndJog(press_id=press):
                self._end_press(press)
            case Step(axis=axis, delta_deg=degrees):
                self._turn(axis, degrees)
            case SetHome():
                self.before_zero = (self.position, self.memory.home)
                self.position = Pair(0.0, 0.0)
                self.memory = replace(self.memory, home=HomeTrust(now, actor, N_("set manually"), 3))
            case UndoHome():
                if self.before_zero is None:
                    raise CommandRejected(NO_FORMER_HOME)
                self.position, home = self.before_zero
                self.memory, self.before_zero = replace(self.memory, home=home), None
            case Home():
                raise CommandRejected(NO_SWITCHES)
            case SelectMode(mode=mode, orientation=held):
                self.memory = replace(self.memory, mode=mode, orientation=held or self.memory.orientation)
            case Move(orientation=to):
                self._go(to)
            case Park():
                self._go(self.config.park)
            case Track():
                self.memory = replace(self.memory, tracking_on=True)
                self.activity = ActivityName.TRACKING
            case GoToStart(plan=plan):
                self._show(plan, ShowPhase.READY)
            case RunShow(plan=plan):
                self._show(plan, ShowPhase.RUNNING)
            case PauseShow() | ResumeShow():
                if self.show is None:
                    raise CommandRejected(NO_SHOW)
                paused = isinstance(command, PauseShow)
                self.show = (self.show[0], ShowPhase.PAUSED if paused else ShowPhase.RUNNING)
            case Stop() | StopShow() | ResetFault():
                self._stop()

    def _jog(self, jog: Jog, now: datetime) -> None:
        if jog.press_id in self.dead:
            raise CommandRejected(Reason("press_dead", "This jog command has ended.", "Press the key again."))
        if self.press not in (None, jog.press_id):
            raise CommandRejected(
                Reason("busy", "Somebody else is moving this axis.", "Wait until it stands.")
            )
        if self.activity not in (ActivityName.HOLDING, ActivityName.JOGGING):
            raise CommandRejected(STOP_FIRST)
        self.press, self.activity = jog.press_id, ActivityName.JOGGING
        self.held_until = now + min(jog.lease, JOG_LEASE)
        axis = self.config.axis(jog.axis)
        speed = axis.jog_fast_dps if jog.speed is JogSpeed.FAST else axis.jog_slow_dps
        self._turn(jog.axis, copysign(speed * 0.05, jog.direction))

    def overdue(self, now: datetime) -> list[Event]:
        """End a jog that was not renewed in time, and return what the journal says of it."""
        if self.press is None or now < self.held_until:
            return []
        self._end_press(self.press)
        data = {"outcome": "expired"}
        return [Event(now, EventKind.JOG_ENDED, self.config.tracker_id, NOT_RENEWED, data=data)]

    def _end_press(self, press_id: str) -> None:
        self.dead.add(press_id)
        if self.press == press_id:
            self.press, self.activity = None, ActivityName.HOLDING

    def _turn(self, axis: Axis, degrees: float) -> None:
        azimuth, elevation = self.position.azimuth_deg, self.position.elevation_deg
        if axis is Axis.AZIMUTH:
            self.position = Pair(self.config.azimuth.clamp(azimuth + degrees), elevation)
        else:
            self.position = Pair(azimuth, self.config.elevation.clamp(elevation + degrees))

    def _go(self, to: Orientation) -> None:
        self.position = Pair(to.azimuth_deg, to.elevation_deg)
        self._stop()

    def _show(self, plan: ShowPlan, phase: ShowPhase) -> None:
        self.show = (plan, phase)
        self.activity = ActivityName.SHOWING
        self.memory = replace(self.memory, tracking_on=False, showing=plan.show_id)

    def _stop(self) -> None:
        if self.press:
            self.dead.add(self.press)
        self.press, self.show, self.activity = None, None, ActivityName.HOLDING
        self.memory = replace(self.memory, tracking_on=False, showing=None)

    def snapshot(self, at: datetime, tick: int) -> Snapshot:
        """Return what the panel shows of this tracker."""
        shown = self._progress(at)
        sun = made_up_sun(shown.sun_time if shown else at)
        if self.activity is ActivityName.TRACKING and sun.elevation_deg > 0:
            self.position = Pair(round(sun.azimuth_deg, 1), round(sun.elevation_deg, 1))
        where = self.position
        off = separation_deg(sun.azimuth_deg, sun.elevation_deg, where.azimuth_deg, where.elevation_deg)
        moving = self.activity is ActivityName.JOGGING
        axis = AxisState(moving, self.memory.home is not None, False, False, False)
        return Snapshot(
            tracker_id=self.config.tracker_id,
            name=self.config.name,
            at=at,
            tick=tick,
            activity=self.activity,
            approaching=self.approaching,
            sensors=self.sensors,
            activity_text=join("", (Word(self.activity.value.capitalize()), ".")),
            mode=self.memory.mode or Mode.FIXED,
            orientation=self.memory.orientation,
            tracking_on=self.memory.tracking_on,
            sun=sun,
            sun_is_up=sun.elevation_deg > 0,
            target=where,
            setpoint=where,
            measured=where,
            last_measured=where,
            position_age_s=0.04,
            following_error_deg=0.01,
            off_sun_deg=off if sun.elevation_deg > 0 else None,
            in_position=not moving,
            homed=self.memory.home is not None,
            azimuth=replace(axis, position_deg=where.azimuth_deg),
            elevation=replace(axis, position_deg=where.elevation_deg),
            can_undo_home=self.before_zero is not None,
            fault=None,
            not_stowed=self.not_stowed,
            show=self._progress(at),
            actions=self._actions(),
        )

    def _actions(self) -> dict[str, tuple[Reason, ...]]:
        busy = () if self.activity in (ActivityName.HOLDING, ActivityName.JOGGING) else (STOP_FIRST,)
        forbidden: dict[str, tuple[Reason, ...]] = dict.fromkeys(ACTIONS, ())
        forbidden |= dict.fromkeys(("jog", "step", "set_home", "set_mode"), busy)
        forbidden["home"] = (NO_SWITCHES,)
        if self.show is None:
            forbidden |= dict.fromkeys(("pause_show", "resume_show", "stop_show"), (NO_SHOW,))
        return forbidden

    def _progress(self, at: datetime) -> ShowProgress | None:
        if self.show is None:
            return None
        plan, phase = self.show
        elapsed = plan.duration * self.shown if phase is not ShowPhase.READY else timedelta()
        return ShowProgress(
            plan.show_id, phase, plan.sun_time(elapsed), elapsed.total_seconds(),
            plan.duration.total_seconds(), plan.acceleration, plan.begin_at, plan.end_at, sun_is_up=True,
        )  # fmt: skip
