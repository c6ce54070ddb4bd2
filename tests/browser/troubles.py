"""A tracker in every trouble at once, and a machine that knows it: how full a page can become."""

from dataclasses import replace
from datetime import datetime, timedelta
from typing import Any

from app.tracker.commands.control import ControlRequest, ControlState
from app.tracker.memory.memory import CommissioningLock, RejectedSetting
from app.tracker.protections.words import (
    LinkQuality,
    MaintenanceLock,
    Protection,
    ProtectionState,
    ServiceMode,
    ServiceState,
    WarningState,
)
from app.tracker.settings.protections import StowName
from app.tracker.state.snapshot import ActivityName, Pair, Snapshot
from app.tracker.values.alarm_words import AlarmNow, AlarmState
from app.tracker.values.reason import Reason
from app.tracker.weather.weather import Quality, Reading, Weather, WeatherNow
from tests.fake_alarms import alarm
from tests.fake_data import commissioned
from tests.fake_tracker import FakeTracker
from tests.fakes import FakeMachine

NAME = "South-eastern field behind the workshop"
PERSON = "maria-magdalena.ionescu"
STATES = (AlarmState.UNACKNOWLEDGED, AlarmState.ACKNOWLEDGED, AlarmState.RETURNED, AlarmState.SHELVED)
CODES = ("not_stowed", "drive_lost", "link_poor", "gateway_down")
REFUSED = Reason(
    "stow_demanded",
    f"{NAME} must be stowed because of high wind.",
    "Wait until that has ended. If the tracker is not stowed yet, press Stow.",
)
FAULT = Reason(
    "following_error",
    f"The elevation axis of {NAME} does not follow its setpoint: the following error is 4.2 degrees.",
    "Check the axis for obstructions, check motor and coupling, then reset the fault.",
)
LOCAL = Reason(
    "local",
    f"The switch at the cabinet of {NAME} is on local.",
    "The tracker is operated from its cabinet. Turn the switch to remote to use Heliopanel.",
)
ZERO = Reason(
    "tracker_not_homed", f"{NAME} is not homed.", "Go to step 3, Homing, and set the home position."
)  # fmt: skip
CLOCK = Reason(
    "clock_untrusted", "The site's clock is not trusted.", "Go to step 2, Clock, and set or confirm it."
)
AREA = Reason(
    "area_not_clear",
    f"The area-clear confirmation for {NAME} has expired.",
    "Check that the area is clear, then press Confirm area clear.",
)


class TroubledTracker(FakeTracker):
    """A tracker about which a page has as much to tell as it ever can."""

    def snapshot(self, at: datetime, tick: int) -> Snapshot:
        calm = super().snapshot(at, tick)
        refused = dict.fromkeys(calm.actions, (REFUSED, LOCAL, ZERO))
        return replace(calm, **troubles(at), actions=refused | {"stop": (), "park": (), "stow": ()})


def troubles(at: datetime) -> dict[str, Any]:
    """Return what is amiss, as the fields of a snapshot."""
    since = at - timedelta(minutes=12)
    return {
        "activity": ActivityName.FAULTED,
        "activity_text": FAULT.message,
        "measured": None,
        "last_measured": Pair(359.99, -12.34),
        "position_age_s": 754.0,
        "fault": FAULT,
        "waiting": (ZERO, CLOCK),
        "notices": (AREA, LOCAL),
        "local": True,
        "not_stowed": replace(REFUSED, code="not_stowed"),
        "protection": ProtectionState(Protection.WIND_STOW, since, at + timedelta(minutes=9), REFUSED),
        "stow": StowName.WIND,
        "warning": WarningState(4.0, AREA),
        "service": ServiceState(ServiceMode(PERSON, PERSON, since), 0.0),
        "lock": MaintenanceLock(PERSON, PERSON, since, "The gearbox of the elevation axis is open."),
        "link": LinkQuality(0.9, 1.0),
        "home": None,
        "home_lost": "the drive has restarted",
        "home_lost_at": since,
        "settings_lock": CommissioningLock(PERSON, since),
        "control": ControlState(7, PERSON, "session", 2, since=since, request=_wish(at)),
        "rejected": (RejectedSetting("deadband", "-4", "0.5", "It must be above 0.", True),),
    }


def _wish(at: datetime) -> ControlRequest:
    reason = "The wind rises and somebody must stow it now."
    return ControlRequest(PERSON, "session", True, reason, at + timedelta(seconds=8), can_be_refused=True)


def alarms(at: datetime) -> tuple[AlarmNow, ...]:
    """Return an alarm of every priority, each in another state."""
    until = at + timedelta(hours=1)
    return tuple(
        replace(alarm(code, at), state=state, shelved_until=until if state is AlarmState.SHELVED else None)
        for code, state in zip(CODES, STATES, strict=True)
    )


def trouble(machine: FakeMachine) -> None:
    """Bring a machine into every trouble."""
    now = machine.clock.now()
    machine.trackers["T3"] = TroubledTracker(commissioned("T3", NAME, tracking=False), Pair(180.0, 45.0))
    machine.alarms = alarms(now)
    machine.rejects["park"] = (REFUSED, LOCAL)
    machine.weather = WeatherNow(
        Weather(23.4, 247.6, 1013.0, 120.5, 1234.0, -12.3), now, 754.0, True, "SIMULATED station",
        gust_mps=31.2, mean_mps=19.9, simulated=True,
        winds={"mast": Reading(23.4, Quality.GOOD), "roof": Reading(3.1, Quality.FROZEN)},
    )  # fmt: skip
    machine.emit()
