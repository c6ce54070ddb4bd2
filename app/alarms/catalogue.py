"""Every alarm there is: one entry a code, with its priority, what follows, and what to do.

The priority comes from what follows if nobody acts and from the time there is to act, as ANSI/ISA-18.2 has
it: 1 within a minute or two, 2 within 10 minutes, 3 within hours, 4 within days. What needs no action of an
operator is no alarm but an event in the journal. To add an alarm: one entry here, one in the operator's
guide (docs/operate/operators-guide.md, Alarms).
"""

from dataclasses import dataclass
from datetime import timedelta
from enum import StrEnum

SOON = timedelta(0)
SHORT = timedelta(seconds=3)
LONG = timedelta(seconds=30)


class Group(StrEnum):
    """Alarms that one cause may raise together: the first of them is marked."""

    MOTION = "motion"
    DRIVE = "drive"
    WEATHER = "weather"
    CLOCK = "clock"
    STORE = "store"
    LOAD = "load"
    INTERFACES = "interfaces"
    ALARMS = "alarms"

    @classmethod
    def _missing_(cls, value: object) -> "Group | None":
        """Return what is stored under a former name."""
        return cls.INTERFACES if value == "doors" else None


@dataclass(frozen=True, slots=True)
class Entry:
    """One kind of alarm.

    It is raised once its condition has lasted `on_delay`, and has returned once that was gone for
    `off_delay`. While one of the codes in `suppressed_by` is active at the same place it is suppressed by
    design. Alarms of its group, and of the groups in `caused_by`, may be its cause.
    Raises `ValueError` for a priority other than 1 to 4.
    """

    code: str
    priority: int
    group: Group
    title: str
    consequence: str
    do: str
    on_delay: timedelta = SOON
    off_delay: timedelta = SHORT
    suppressed_by: tuple[str, ...] = ()
    caused_by: tuple[Group, ...] = ()

    @property
    def kin(self) -> frozenset[Group]:
        """Return the groups of the alarms that may be its cause, its own among them."""
        return frozenset((self.group, *self.caused_by))

    def __post_init__(self) -> None:
        if self.priority not in (1, 2, 3, 4):
            raise ValueError(f"Alarm {self.code} has priority {self.priority}; the valid range is 1 to 4.")


ENTRIES = (
    Entry(
        "not_stowed", 1, Group.WEATHER, "Not stowed",
        "Wind or snow may damage the panel.",
        ("Remove what blocks the panel, then press Stow against wind or Stow against snow. If the "
        "panel does not move, keep everyone clear and use the manual control at the cabinet."),
        SHORT, caused_by=(Group.MOTION, Group.DRIVE),
    ),
    Entry(
        "stop_overdue", 1, Group.MOTION, "Axes do not stop",
        "The panel is still moving after a stop command.",
        "Press the emergency stop at the cabinet, then find the fault in the drive.",
    ),
    Entry(
        "internal_error", 1, Group.MOTION, "Controller error: tracker not controlled",
        "This tracker no longer moves, not even to stow in strong wind.",
        ("Reset the fault. If the fault recurs, keep everyone clear, stow the panel with the "
        "manual control at the cabinet, and send the diagnostics file."),
    ),
    Entry(
        "config_rejected", 2, Group.MOTION, "Stored settings rejected",
        "The tracker is at standstill and does not stow. Stored settings that were not valid were replaced.",
        ("Compare the stored and used values on the tracker's Settings page, correct and save "
        "them, then set the home position again."),
    ),
    Entry(
        "wrong_direction", 2, Group.MOTION, "Axis moves the wrong way",
        "The panel moves away from its target and may reach its mechanical end.",
        ("Check the motor's phases and the direction set in the drive. Reset the fault, then set "
        "the home position again."),
    ),
    Entry(
        "following_error", 2, Group.MOTION, "Axis does not follow",
        "The axis is blocked, or the motor has no torque: no tracking and no stow.",
        "Remove what blocks the axis, check the motor and coupling, then reset the fault.",
    ),
    Entry(
        "encoder_jump", 2, Group.MOTION, "Position jumped",
        "The true position is unknown: the soft limits do not protect the tracker.",
        "Check the encoder and its cable, reset the fault, then set the home position again in step 3.",
    ),
    Entry(
        "limit_switch", 2, Group.MOTION, "Limit switch reached",
        "The axis is at its end; the home position may be wrong.",
        "Jog the axis away from the switch and check the home position.",
    ),
    Entry(
        "limit_switch_wiring", 2, Group.MOTION, "Limit switches contradict each other",
        "The switches do not protect the tracker.",
        "Check the wiring of the switches, then reset the fault.",
    ),
    Entry(
        "position_frozen", 2, Group.MOTION, "Position frozen",
        "The drive reports motion, but its counter does not change: the true position is unknown.",
        "Check the encoder and its cable, reset the fault, then set the home position again in step 3.",
    ),
    Entry(
        "axes_swapped", 2, Group.MOTION, "The wrong axis moves",
        ("The panel moves in an uncommanded direction: the axes are swapped, or two drives have "
        "the same address."),
        "Check the unit ids and the motor cables of both axes, then reset the fault.",
    ),
    Entry(
        "limit_stuck", 2, Group.MOTION, "Limit switch stays on",
        "The switch does not protect the tracker and blocks motion in one direction.",
        "Check the switch and its cable, then reset the fault.",
    ),
    Entry(
        "over_travel", 2, Group.MOTION, "Axis beyond its soft limits",
        "The axis may reach its end; the home position may be wrong.",
        "Find out why the axis did not stop, reset the fault, then set the home position again in step 3.",
    ),
    Entry(
        "creep", 2, Group.MOTION, "Axis moves without a command",
        "The panel drifts, or another master moves it.",
        "Keep everyone clear; check the brake, and whether wind or another master moves the axis.",
    ),
    Entry(
        "overrun", 3, Group.MOTION, "Stopping distance exceeded",
        ("The axis may run into its end or hit a person. It moves slowly until its stopping "
        "distance is short again."),
        "Check the brake and load, then repeat the stop test on the Drive tests page.",
    ),
    Entry(
        "supply_voltage", 2, Group.DRIVE, "Supply voltage out of range",
        "The tracker is at standstill and does not stow.",
        "Check the supply and its cables, then reset the fault.",
    ),
    Entry(
        "move_overdue", 2, Group.MOTION, "Move takes too long",
        "The axis is slow or blocked: a stow would also be late.",
        "Remove what blocks the axis, then start the move again.",
    ),
    Entry(
        "home_position_not_set", 3, Group.MOTION, "Home position not set",
        "Without a home position, the tracker does not track or stow.",
        "Read the reason in the journal, then set the home position again in step 3.",
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "home_lost", 2, Group.MOTION, "Home reference lost",
        "The tracker does not track or stow until the home position is set again.",
        "Compare the panel with the angles shown, then go to step 3, Homing, and set the home position.",
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "fault", 2, Group.MOTION, "Stopped with a fault",
        "The tracker is at standstill and does not stow.",
        "Read the fault on the tracker's page, remove its cause, then reset the fault.",
    ),
    Entry(
        "drive_fault", 2, Group.DRIVE, "Drive reports a fault",
        "The tracker is at standstill and does not stow.",
        "Look up the code in the drive's manual, remove the cause, then reset the fault.",
    ),
    Entry(
        "drive_lost", 2, Group.DRIVE, "Drive does not answer",
        "Position unknown: no tracking, no stow. A drive with a watchdog has stopped automatically.",
        "Check its power and cable. Heliopanel retries the connection automatically.",
        SHORT,
    ),
    Entry(
        "watchdog_tripped", 3, Group.DRIVE, "Drive stopped by its watchdog",
        "The connection or the controller's computer is too slow at times; tracking is interrupted.",
        "Check the network and the load on the controller's computer, then press Start tracking.",
    ),
    Entry(
        "drive_restarted", 3, Group.DRIVE, "Drive has restarted",
        "The home position of the drive may be lost.",
        "Find out why the drive lost its supply. If prompted, set the home position again in step 3.",
    ),
    Entry(
        "drive_elsewhere", 3, Group.DRIVE, "Position changed while drive was offline",
        "The home position may be wrong.",
        "Compare the angles with the panel. If they differ, set the home position again in step 3.",
    ),
    Entry(
        "stopped_meanwhile", 3, Group.DRIVE, "Motion stopped during communication loss",
        "The motion in progress did not finish.",
        "Find out why the connection failed, then restart the interrupted motion.",
    ),
    Entry(
        "link_poor", 3, Group.DRIVE, "Connection to the drive is poor",
        "Readings fail repeatedly; the connection may be lost soon.",
        "Check the cable, shield, termination, and address; see the link quality in the metrics.",
        LONG, LONG, ("drive_lost",),
    ),
    Entry(
        "operator_needed", 3, Group.MOTION, "Tracking waits for the operator",
        "No energy is gained by tracking until an operator starts it.",
        "Find out why tracking was interrupted, then press Start tracking.",
        SHORT, SHORT, ("drive_lost", "drive_fault", "home_lost"),
    ),
    Entry(
        "wind_sensor_bad", 2, Group.WEATHER, "Wind sensor fault",
        "Strong wind would not be detected, or the panel stays stowed.",
        "Check the sensor, its cable, and its address; stow the panel if strong wind is forecast.",
        SHORT, LONG,
    ),
    Entry(
        "wind_sensors_disagree", 3, Group.WEATHER, "Wind sensors disagree",
        ("The higher wind speed is used: the panel may be stowed unnecessarily, or the faulty "
        "sensor may miss a storm."),
        "Compare both sensors with the actual wind; check or switch off the faulty one.",
        SHORT, LONG,
    ),
    Entry(
        "snow_sensor_bad", 3, Group.WEATHER, "Snow sensor fault",
        "A snow load would not be detected.",
        "Check the sensor, its cable, and its address; inspect the panel when it snows.",
        SHORT, LONG,
    ),
    Entry(
        "light_sensor_bad", 4, Group.WEATHER, "Irradiance sensor fault",
        "The tracker does not enter low-light hold in the dark, or holds in daylight.",
        "Check the sensor, its cable, and its address.",
        SHORT, LONG,
    ),
    Entry(
        "clock_jumped", 3, Group.CLOCK, "Clock has jumped",
        "Automatic motion is held until the clock is confirmed or has been stable for 60 s.",
        "Compare the clock in the header with a reliable clock and confirm it in step 2.",
    ),
    Entry(
        "clock_implausible", 2, Group.CLOCK, "Clock time implausible",
        "No tracking: the sun position is unknown.",
        "Set the clock in step 2. If this happens after every start, replace the clock battery.",
    ),
    Entry(
        "clock_drifts", 3, Group.CLOCK, "Clock drift",
        "The panel has a small pointing error. Tracking stops at a clock error of 5 minutes.",
        ("Compare the clock in the header with a reliable clock and set it in step 2. Use NTP to "
        "keep the clock correct."),
    ),
    Entry(
        "clock_off", 2, Group.CLOCK, "Clock is minutes off",
        "No tracking: the panel would have a pointing error.",
        ("Set the clock in step 2. If the sun check reports this although the clock is right, "
        "check the home position."),
    ),
    Entry(
        "zones_missing", 4, Group.CLOCK, "Time zones are missing",
        "All times are shown in UTC; tracking is not affected.",
        "Install tzdata on the controller's computer, then restart Heliopanel.",
    ),
    Entry(
        "store_behind", 2, Group.STORE, "Nothing can be stored",
        "Tracking continues, but the journal, settings, and recordings are lost if power fails.",
        "Free disk space, or check the card and the database. Restart Heliopanel if the alarm stays active.",
        SHORT, SHORT, ("disk_full",),
    ),
    Entry(
        "store_damaged", 1, Group.STORE, "Database damaged",
        "Safe mode: no motion, not even to stow in strong wind; drives can be stopped. Nothing is recorded.",
        ("Restore a backup on the Restore page. Keep everyone clear; in strong wind, stow with the "
        "manual control at the cabinet."),
    ),
    Entry(
        "disk_full", 2, Group.STORE, "Disk is full",
        "No more samples are recorded; soon the journal and settings cannot be stored either.",
        "Delete recordings or other files on the controller's computer now.",
        SHORT, LONG,
    ),
    Entry(
        "disk_low", 3, Group.STORE, "Disk is nearly full",
        "Soon nothing can be stored.",
        "Delete recordings that are not needed, or other files on the controller's computer.",
        LONG, LONG, ("disk_full",),
    ),
    Entry(
        "overloaded", 3, Group.LOAD, "Controller is overloaded",
        "Pages show new values once a second and nothing is recorded; motion and stops stay on time.",
        ("Close other programs on the controller's computer. If that does not help, use fewer "
        "trackers or a longer period."),
        SOON, SHORT,
    ),
    Entry(
        "ticks_late", 3, Group.LOAD, "Control cycle overrun",
        "The controller's computer is overloaded: trackers react late, and jogging may end early.",
        "Close other programs on the controller's computer; see the tick lateness in the metrics.",
        SHORT, LONG,
    ),
    Entry(
        "memory_high", 3, Group.LOAD, "Controller memory high",
        "At twice its memory limit, the system may end the controller service. Drives then stop; "
        "tracking continues after the restart.",
        "Press Stop when tracking can be interrupted for a few seconds: the controller service "
        "then restarts automatically. Afterward, start tracking again.",
        SHORT, LONG,
    ),
    Entry(
        "gateway_down", 4, Group.INTERFACES, "An integration is not connected",
        "Other systems receive no data from this site.",
        "See Integrations on the Site page for the interface and the cause.",
        LONG, SHORT,
    ),
    Entry(
        "notification_failed", 4, Group.INTERFACES, "Alarms are not sent",
        "Users away from this screen are not notified of alarms.",
        "Open Notifications on the Site page, correct the address, and send a test message.",
    ),
    Entry(
        "alarm_flood", 2, Group.ALARMS, "Alarm flood",
        "More than 10 alarms were raised within 10 minutes; priorities 3 and 4 are listed last.",
        "Respond to priorities 1 and 2 first, starting with the alarm marked as first.",
        SOON, SOON,
    ),
)  # fmt: skip

CATALOGUE: dict[str, Entry] = {entry.code: entry for entry in ENTRIES}
"""Every entry by its code."""

FLOOD = "alarm_flood"
ANY_FAULT = "fault"
"""The entry of a fault whose code has none of its own."""


def entry_of(code: str) -> Entry:
    """Return the entry of a code; a code of another version has the least priority."""
    known = CATALOGUE.get(code)
    if known is not None:
        return known
    title = code.replace("_", " ").capitalize()
    return Entry(
        code, 4, Group.ALARMS, title, "No longer known.", "No action: this alarm is from the history."
    )
