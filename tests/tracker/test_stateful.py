"""Whatever is asked, in whatever order, with whatever going wrong: what must always hold.

Random commands, faults of the machine, cut cables, weather, bad sensors, jumps of the clock and restarts; a
witness looks at every tick. The short run is part of `make test`, millions of ticks are part of `make soak`.
"""

import os
from collections.abc import Iterator
from dataclasses import replace
from datetime import timedelta

import hypothesis.strategies as st
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

from app.alarms.catalogue import CATALOGUE
from app.simulation.faults import Fault, FaultKind
from app.tracker.access.interlocks import Action
from app.tracker.commands.commands import (
    Command,
    CommandRejected,
    EndJog,
    GoToStart,
    Home,
    Jog,
    Move,
    Park,
    PauseShow,
    ReleaseInhibit,
    ResetFault,
    Resume,
    ResumeShow,
    RunShow,
    SelectMode,
    SetHome,
    SetInhibit,
    Step,
    Stop,
    StopShow,
    Stow,
    Track,
)
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import Orientation
from app.tracker.settings.protections import (
    LightProtection,
    ProtectionConfig,
    SnowProtection,
    StowName,
    WindProtection,
)
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.mode import Mode
from tests.amount import SOAK, amount
from tests.patience import TEST_S
from tests.tracker.plant import CONFIG, READY, Plant
from tests.tracker.test_controller_show import PLAN
from tests.tracker.witness import Witness, moves

EXAMPLES = int(os.environ.get("HELIOPANEL_TEST_EXAMPLES", amount(20, 1500)))
STEPS = amount(25, 50)
LONGEST_S = amount(8.0, 40.0)
QUICK = ProtectionConfig(
    wind=WindProtection(resume_after_s=10.0, bad_after_s=3.0),
    snow=SnowProtection(hold_s=3.0, bad_after_s=3.0),
    light=LightProtection(hold_s=5.0, bad_after_s=3.0),
    warning_s=1.0,
)
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
            FaultKind.FROZEN_POSITION,
            FaultKind.WRONG_DIRECTION,
            FaultKind.POWER_LOSS,
            FaultKind.DRIVE_FAULT,
        ]
    ),
    AXES,
    st.floats(1.0, 50.0),
)
GUARDING = [Resume(), SetInhibit("Ayşe", "greasing"), ReleaseInhibit(), *(Stow(name) for name in StowName)]
COMMANDS: st.SearchStrategy[Command] = st.one_of(
    st.builds(Step, AXES, st.sampled_from([-5.0, -0.1, 1.0, 5.0, 9.0])),
    st.just(SetHome()),
    st.just(Home()),
    st.builds(SelectMode, st.sampled_from(Mode), ORIENTATIONS),
    st.builds(Move, ORIENTATIONS),
    st.just(Park()),
    st.just(Track()),
    st.sampled_from(
        [GoToStart(PLAN), RunShow(PLAN), PauseShow(), ResumeShow(), StopShow(), ResetFault(), Stop()]
    ),
    st.sampled_from(GUARDING),
)
WINDS = st.sampled_from([0.0, 3.0, 16.9, 17.0, 30.0, None])
SNOWS = st.sampled_from([0.0, 0.0, 3.9, 4.0, 9.0, None])
LIGHTS = st.sampled_from([700.0, 600.0, 49.0, 0.0, None])
JUMPS = st.sampled_from(
    [timedelta(hours=1), timedelta(hours=-1), timedelta(days=-365), timedelta(days=30), timedelta(seconds=5)]
)
SENDERS = st.sampled_from(["", "session", "mqtt", "token"])


class Operation(RuleBasedStateMachine):
    """A tracker, its operators, its weather and its bad luck."""

    plant: Plant
    ticks = 0

    @initialize(homed=st.booleans(), tracking_on=st.booleans())
    def begin(self, *, homed: bool, tracking_on: bool) -> None:
        config = replace(CONFIG, protection=QUICK)
        self.plant = Plant(replace(READY, tracking_on=tracking_on), config=config)
        if not homed:
            self.plant.drive.inject(Fault(FaultKind.POWER_LOSS))
        self.witness = Witness(self.plant)
        self.presses = 0
        self.dead: list[Jog] = []
        self.plant.tick()
        self.witness.see()

    @rule(command=COMMANDS, via=SENDERS)
    def command(self, command: Command, via: str) -> None:
        self._ask(command, via)

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

    @rule(tracks=st.booleans())
    def get_moving(self, *, tracks: bool) -> None:
        """Do what a technician would on a fine day to get a tracker going."""
        self.plant.cut, self.plant.clock_trusted = False, True
        self.plant.drive.end_injected_faults()
        self.plant.blow()
        before = self.plant.controller.memory.home
        last = Track() if tracks else Park()
        for command in (Stop(), ReleaseInhibit(), ResetFault(), SetHome(), SelectMode(Mode.DUAL), last):
            self._forward(3.0)
            self._ask(command)
        self._forward(1.0)
        self.witness.sound = self.witness.sound or self.plant.controller.memory.home is not before

    @rule(seconds=st.floats(0.1, LONGEST_S))
    def time_passes(self, seconds: float) -> None:
        self._forward(seconds)

    @rule(wind_mps=WINDS, snow_kg=SNOWS, irradiance_wm2=LIGHTS, seconds=st.floats(0.1, 6.0))
    def the_weather(
        self, wind_mps: float | None, snow_kg: float | None, irradiance_wm2: float | None, seconds: float
    ) -> None:
        self.plant.blow(wind_mps, snow_kg=snow_kg, irradiance_wm2=irradiance_wm2)
        self._forward(seconds)

    @rule(gust_mps=st.sampled_from([17.0, 25.0]), calm_s=st.sampled_from([9.0, 10.0, 11.5]))
    def a_gust_and_then_calm(self, gust_mps: float, calm_s: float) -> None:
        self.plant.blow(gust_mps)
        self._forward(0.1)
        self.plant.blow(3.0)
        self._forward(calm_s)

    @rule(fault=FAULTS)
    def something_breaks(self, fault: Fault) -> None:
        self.witness.sound = False
        self.plant.drive.inject(fault)

    @rule(cut=st.booleans())
    def the_cable(self, *, cut: bool) -> None:
        self.plant.cut = cut
        self._forward(0.3)

    @rule(by=JUMPS, seconds=st.floats(0.1, 5.0))
    def the_clock_jumps(self, by: timedelta, seconds: float) -> None:
        self.plant.jump(by)
        self._forward(seconds)

    @rule()
    def the_clock_is_confirmed(self) -> None:
        self.plant.clock_trusted = True

    @rule()
    def stop_and_see_it_stand(self) -> None:
        self._ask(Stop())
        assert not moves(self.plant.told.azimuth)
        assert not moves(self.plant.told.elevation)
        self._forward(2.0)
        assert not self.plant.controller.memory.tracking_on

    @rule()
    def the_software_restarts(self) -> None:
        controller, plant = self.plant.controller, self.plant
        plant.controller = type(controller)(controller.config, controller.memory, plant.drive.capabilities)
        self.dead.clear()
        self.witness.restart()
        self._forward(0.1)

    @invariant()
    def what_is_shown_is_whole(self) -> None:
        shown = self.plant.snapshot
        assert set(shown.actions) == {action.value for action in Action}
        assert not shown.actions["stop"]
        assert shown.activity_text
        for reason in (reason for reasons in shown.actions.values() for reason in reasons):
            assert reason.code
            assert reason.message[-1] in ".!?"
        if shown.tracking_on and shown.activity not in (ActivityName.TRACKING, *STOWS):
            assert shown.waiting
        if shown.fault is not None:
            assert shown.fault.code in CATALOGUE, f"{shown.fault.code} is no alarm"

    def teardown(self) -> None:
        Operation.ticks += self.witness.ticks if hasattr(self, "witness") else 0

    def _forward(self, seconds: float) -> None:
        self.plant.forward(seconds, self.witness.see)

    def _ask(self, command: Command, via: str = "") -> bool:
        """Give a command; a refusal has reasons that are sentences."""
        try:
            happened = self.plant.controller.handle(command, self.plant.clock.now(), "somebody", via)
        except CommandRejected as rejected:
            refused = rejected.reasons
        else:
            self.plant.events += happened
            self.witness.command(command)
            self.plant.tick()
            self.witness.see()
            return True
        assert refused
        assert not isinstance(command, Stop | EndJog)
        for reason in refused:
            assert reason.code
            assert reason.message.endswith(".")
            assert reason.hint.endswith(".")
        return False


STOWS = (ActivityName.STOWING, ActivityName.STOWED)


@pytest.fixture
def told_how_long() -> Iterator[None]:
    ticks = Operation.ticks
    yield
    print(f"{Operation.ticks - ticks:,} ticks")


@pytest.mark.usefixtures("told_how_long")
@pytest.mark.timeout(amount(TEST_S, 7200.0))
def test_whatever_is_asked_and_whatever_goes_wrong() -> None:
    run_state_machine_as_test(  # type: ignore[no-untyped-call]
        Operation,
        settings=settings(
            max_examples=EXAMPLES,
            stateful_step_count=STEPS,
            deadline=None,
            database=None,
            suppress_health_check=list(HealthCheck),
            print_blob=not SOAK,
        ),
    )
    assert Operation.ticks > EXAMPLES * 100
