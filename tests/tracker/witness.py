"""A witness of a tracker's operation: sees every tick and objects to what must never happen.

It knows commands, weather and readings as anybody beside the machine does, and keeps its own account of
them; of the controller it asks only what it shows and remembers.
"""

from datetime import datetime, timedelta

from app.tracker.commands.commands import (
    Command,
    ConfirmAreaClear,
    EndJog,
    EndServiceMode,
    ReleaseInhibit,
    ResetFault,
    SelectMode,
    SetHome,
    SetInhibit,
    Stop,
)
from app.tracker.settings.axes import Axis
from app.tracker.state.snapshot import ActivityName
from app.tracker.values.motion import AxisCommand, Halt, Position, Velocity
from tests.tracker.plant import Plant

AT_REST = {ActivityName.HOLDING, ActivityName.STOPPING, ActivityName.FAULTED, ActivityName.STOWED}
BY_HAND = {ActivityName.JOGGING, ActivityName.MOVING, ActivityName.MEASURING}
AUTOMATIC = {ActivityName.TRACKING, ActivityName.SHOWING}
NEEDS_TRUST = AUTOMATIC | {ActivityName.STOWING}
LIVE = BY_HAND | NEEDS_TRUST | {ActivityName.HOMING}
MOVES_NOTHING = (
    Stop
    | SelectMode
    | ResetFault
    | SetHome
    | SetInhibit
    | ReleaseInhibit
    | EndJog
    | ConfirmAreaClear
    | EndServiceMode
)
HAND_GRACE = timedelta(seconds=5.2)


def moves(command: AxisCommand) -> bool:
    return not isinstance(command, Halt) and command != Velocity(0.0)


class WindLog:
    """When the wind was last not known to be calm, since it first was too strong."""

    def __init__(self, plant: Plant) -> None:
        self._limits = plant.controller.config.protection.wind
        self._known = False
        self._bad_since: datetime | None = None
        self.unsafe_at: datetime | None = None
        self.begun: datetime | None = None

    def restart(self, now: datetime) -> None:
        self._bad_since = None
        self.unsafe_at = now if self.unsafe_at else None

    def see(self, now: datetime, gust_mps: float | None) -> None:
        self._known = self._known or gust_mps is not None
        self._bad_since = (self._bad_since or now) if gust_mps is None and self._known else None
        feared = self._bad_since is not None and now - self._bad_since >= self._seconds("bad_after_s")
        blown = feared or (gust_mps is not None and gust_mps >= self._limits.gust_mps)
        if blown or (self.unsafe_at is not None and gust_mps is None):
            self.unsafe_at = now
        elif self.unsafe_at is not None and now - self.unsafe_at > self._seconds("resume_after_s"):
            self.unsafe_at = None
        self.begun = None if self.unsafe_at is None else self.begun or now

    def _seconds(self, name: str) -> timedelta:
        return timedelta(seconds=getattr(self._limits, name))


class Witness:
    """Told of every accepted command and of every tick."""

    def __init__(self, plant: Plant) -> None:
        self._plant = plant
        self.wind = WindLog(plant)
        self.ticks = 0
        self.sound = True
        self._commanded = self._fresh = True
        self._stopped = False
        self._before = ActivityName.HOLDING
        self._hand_since: datetime | None = None

    def command(self, command: Command) -> None:
        """Note that a command was taken."""
        self._commanded = True
        if isinstance(command, Stop):
            self._stopped = True
        elif not isinstance(command, MOVES_NOTHING):
            self._stopped = False

    def restart(self) -> None:
        """Note that the software begins a new life."""
        self._fresh = True
        self.wind.restart(self._plant.clock.now())

    def see(self) -> None:
        """Look at what the last tick did."""
        plant, now = self._plant, self._plant.clock.now()
        self.ticks += 1
        self.wind.see(now, plant.weather.wind.good)
        self._hand_since = (self._hand_since or now) if self._moves_by_hand() else None
        if moves(plant.told.azimuth) or moves(plant.told.elevation):
            self._see_motion(plant.activity, now)
        self._see_targets()
        self._see_beginning()
        self._before, self._commanded = plant.activity, False
        self._fresh = self._fresh and plant.cut

    def _see_motion(self, activity: ActivityName, now: datetime) -> None:
        memory = self._plant.controller.memory
        assert activity in LIVE, "nothing moves without a live reason"
        assert memory.fault_code is None
        assert not self._stopped, "a stop stops until somebody commands a motion"
        if activity in NEEDS_TRUST:
            assert memory.home is not None, "nothing automatic moves without a trusted zero"
        if memory.lock is not None:
            assert activity in BY_HAND, "a maintenance lock leaves the hand only"
        if not self._plant.cut:
            self._see_demands(activity, now)

    def _see_demands(self, activity: ActivityName, now: datetime) -> None:
        """The strongest demand wins, and none is left before its condition ends."""
        assert self._plant.clock_trusted or activity is not ActivityName.TRACKING
        if self.wind.begun is None:
            return
        assert activity not in AUTOMATIC, "the wind lets nothing track and no show run"
        if activity is ActivityName.STOWING:
            assert self._plant.controller.memory.protection is not None
            assert "wind stow position" in self._plant.snapshot.activity_text
        if self._hand_since is not None:
            assert now - max(self.wind.begun, self._hand_since) <= HAND_GRACE

    def _moves_by_hand(self) -> bool:
        text = self._plant.snapshot.activity_text
        return text.startswith(("Jogging", "Moving to the orientation", "Moving by one increment"))

    def _see_targets(self) -> None:
        """No target beyond a soft limit; a sound tracker that knows its zero stays within them."""
        plant = self._plant
        if plant.controller.memory.home is None:
            return
        pairs = ((Axis.AZIMUTH, plant.told.azimuth), (Axis.ELEVATION, plant.told.elevation))
        for axis, command in pairs:
            if isinstance(command, Position) and plant.activity in NEEDS_TRUST | {ActivityName.JOGGING}:
                assert plant.controller.config.axis(axis).beyond_deg(command.position_deg) < 1e-9
        if self.sound:
            assert plant.controller.config.azimuth.beyond_deg(plant.azimuth_deg) < 0.1
            assert plant.controller.config.elevation.beyond_deg(plant.elevation_deg) < 0.1

    def _see_beginning(self) -> None:
        """What is at rest begins to move by a command, after a restart, or to a stow that was commanded."""
        activity, memory = self._plant.activity, self._plant.controller.memory
        if self._commanded or self._before not in AT_REST or activity in AT_REST:
            return
        if self._before is ActivityName.STOWED:
            assert activity in (ActivityName.STOWING, ActivityName.TRACKING)
            assert activity is ActivityName.STOWING or memory.tracking_on
        elif activity is not ActivityName.STOWING or memory.stow is None:
            assert activity in (ActivityName.TRACKING, ActivityName.STOWING), f"{activity} began by itself"
            assert self._fresh, "only a restart lets tracking go on"
            assert memory.tracking_on
