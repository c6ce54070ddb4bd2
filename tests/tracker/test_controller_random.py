"""Whatever is asked, in whatever order, with whatever going wrong: what must always hold."""

from dataclasses import replace

import hypothesis.strategies as st
from hypothesis import HealthCheck, settings
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from app.drives.faults import Fault, FaultKind
from app.tracker.axes import Axis, JogSpeed
from app.tracker.commands import (
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
    SetZero,
    Step,
    Stop,
    StopShow,
    Track,
)
from app.tracker.conditions import Action
from app.tracker.config import Orientation
from app.tracker.mode import Mode
from app.tracker.motion import AxisCommand, Halt, Position, Velocity
from app.tracker.snapshot import ActivityName
from tests.tracker.plant import CONFIG, READY, Plant
from tests.tracker.test_controller_show import PLAN

LIVE = {
    ActivityName.JOGGING,
    ActivityName.MOVING,
    ActivityName.TRACKING,
    ActivityName.SHOWING,
    ActivityName.HOMING,
}
NEEDS_TRUST = {ActivityName.TRACKING, ActivityName.SHOWING}
ORIENTATIONS = st.builds(Orientation, st.floats(-10.0, 370.0), st.floats(-5.0, 95.0))
AXES = st.sampled_from(Axis)
FAULTS = st.builds(
    Fault,
    st.sampled_from(
        [
            FaultKind.STALL,
            FaultKind.LOWER_LIMIT_STUCK,
            FaultKind.UPPER_LIMIT_STUCK,
            FaultKind.ENCODER_JUMP,
            FaultKind.WRONG_DIRECTION,
            FaultKind.POWER_LOSS,
            FaultKind.DRIVE_FAULT,
        ]
    ),
    AXES,
    st.floats(1.0, 50.0),
)
COMMANDS: st.SearchStrategy[Command] = st.one_of(
    st.builds(Step, AXES, st.sampled_from([-5.0, -0.1, 1.0, 5.0, 9.0])),
    st.just(SetZero()),
    st.just(Home()),
    st.builds(SelectMode, st.sampled_from(Mode), ORIENTATIONS),
    st.builds(Move, ORIENTATIONS),
    st.just(Park()),
    st.just(Track()),
    st.sampled_from(
        [GoToStart(PLAN), RunShow(PLAN), PauseShow(), ResumeShow(), StopShow(), ResetFault(), Stop()]
    ),
)


def moves(command: AxisCommand) -> bool:
    return not isinstance(command, Halt) and command != Velocity(0.0)


class Operation(RuleBasedStateMachine):
    """A tracker, its operators and its bad luck."""

    plant: Plant

    @initialize(homed=st.booleans(), tracking_on=st.booleans())
    def begin(self, *, homed: bool, tracking_on: bool) -> None:
        home = READY.home if homed else None
        self.plant = Plant(replace(READY, home=READY.home, tracking_on=tracking_on))
        if home is None:
            self.plant.drive.inject(Fault(FaultKind.POWER_LOSS))
        self.presses = 0
        self.press: Jog | None = None
        self.dead: list[Jog] = []
        self.sound = True
        self.plant.tick()

    @rule(command=COMMANDS)
    def command(self, command: Command) -> None:
        self._ask(command)

    @rule(axis=AXES, direction=st.sampled_from([-1, 1]), seconds=st.floats(0.1, 3.0))
    def hold_a_key(self, axis: Axis, direction: int, seconds: float) -> None:
        self.presses += 1
        press = Jog(f"p{self.presses}", axis, 1 if direction > 0 else -1, JogSpeed.FAST)
        for sequence in range(round(seconds / 0.1)):
            if not self._ask(replace(press, sequence=sequence)):
                break
            self._forward(0.1)
        self.dead.append(press)
        self._ask(EndJog(press.press_id))

    @rule(axis=AXES)
    def press_and_lose_contact(self, axis: Axis) -> None:
        self.presses += 1
        press = Jog(f"p{self.presses}", axis, -1)
        self._ask(press)
        self._forward(0.5)
        assert self.plant.activity is not ActivityName.JOGGING
        self.dead.append(press)

    @precondition(lambda self: self.dead)
    @rule(sequence=st.integers(0, 3), pick=st.integers(0, 1000))
    def an_old_heartbeat_arrives(self, sequence: int, pick: int) -> None:
        press = self.dead[pick % len(self.dead)]
        before = self.plant.activity
        assert not self._ask(replace(press, sequence=sequence))
        assert self.plant.activity is not ActivityName.JOGGING or before is ActivityName.JOGGING

    @rule()
    def get_moving(self) -> None:
        """Do what a technician would to get a tracker going."""
        self.plant.cut = False
        self.plant.drive.clear_faults()
        before = self.plant.controller.memory.home
        for command in (Stop(), ResetFault(), SetZero(), SelectMode(Mode.DUAL), Track()):
            self._forward(3.0)
            self._ask(command)
        self._forward(1.0)
        self.sound = self.sound or self.plant.controller.memory.home is not before

    @rule(seconds=st.floats(0.1, 8.0))
    def time_passes(self, seconds: float) -> None:
        self._forward(seconds)

    @rule(fault=FAULTS)
    def something_breaks(self, fault: Fault) -> None:
        self.sound = False
        self.plant.drive.inject(fault)

    @rule(cut=st.booleans())
    def the_cable(self, *, cut: bool) -> None:
        self.plant.cut = cut
        self._forward(0.3)

    @rule(trusted=st.booleans())
    def the_clock(self, *, trusted: bool) -> None:
        self.plant.clock_trusted = trusted

    @rule()
    def stop_and_see_it_stand(self) -> None:
        self._ask(Stop())
        assert not moves(self.plant.told.azimuth)
        assert not moves(self.plant.told.elevation)
        for _ in range(20):
            self._forward(0.1)
            assert not moves(self.plant.told.azimuth)
            assert not moves(self.plant.told.elevation)
        assert not self.plant.controller.memory.tracking_on

    @rule()
    def the_software_restarts(self) -> None:
        memory, plant = self.plant.controller.memory, self.plant
        plant.controller = type(plant.controller)(CONFIG, memory, plant.drive.capabilities)
        self.dead.clear()
        self._forward(0.1)

    @invariant()
    def nothing_moves_without_a_reason(self) -> None:
        told, activity = self.plant.told, self.plant.activity
        if moves(told.azimuth) or moves(told.elevation):
            assert activity in LIVE
            assert not self.plant.controller.memory.fault_code
            if activity in NEEDS_TRUST:
                assert self.plant.controller.memory.home is not None

    @invariant()
    def no_target_lies_beyond_a_soft_limit(self) -> None:
        if self.plant.activity not in (*NEEDS_TRUST, ActivityName.JOGGING):
            return
        if self.plant.controller.memory.home is None:
            return
        for axis, command in (
            (Axis.AZIMUTH, self.plant.told.azimuth),
            (Axis.ELEVATION, self.plant.told.elevation),
        ):
            if isinstance(command, Position):
                assert CONFIG.axis(axis).beyond_deg(command.position_deg) < 1e-9

    @invariant()
    def a_sound_homed_tracker_stays_within_its_limits(self) -> None:
        if self.sound and self.plant.controller.memory.home is not None:
            assert CONFIG.azimuth.beyond_deg(self.plant.azimuth_deg) < 0.1
            assert CONFIG.elevation.beyond_deg(self.plant.elevation_deg) < 0.1

    @invariant()
    def what_is_forbidden_says_why(self) -> None:
        shown = self.plant.snapshot
        assert set(shown.actions) == {action.value for action in Action}
        assert not shown.actions["stop"]
        assert shown.activity_text
        for reason in (reason for reasons in shown.actions.values() for reason in reasons):
            assert reason.code
            assert reason.message[-1] in ".!?"
        if shown.tracking_on and shown.activity is not ActivityName.TRACKING:
            assert shown.waiting

    def _forward(self, seconds: float) -> None:
        self.plant.forward(seconds, self._check)

    def _check(self) -> None:
        self.nothing_moves_without_a_reason()
        self.no_target_lies_beyond_a_soft_limit()

    def _ask(self, command: Command) -> bool:
        """Give a command; a refusal has reasons that are sentences."""
        try:
            self.plant.ask(command, "somebody")
        except CommandRejected as rejected:
            refused = rejected.reasons
        else:
            return True
        assert refused
        assert not isinstance(command, Stop | EndJog)
        for reason in refused:
            assert reason.code
            assert reason.message.endswith(".")
            assert reason.hint.endswith(".")
        return False


Operation.TestCase.settings = settings(
    max_examples=40,
    stateful_step_count=25,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
TestOperation = Operation.TestCase
