"""Every alarm there is: one entry a code, with its priority, what follows, and what to do.

The priority comes from what follows if nobody acts and from the time there is to act, as ANSI/ISA-18.2 has
it: 1 within a minute or two, 2 within 10 minutes, 3 within hours, 4 within days. What needs no action of an
operator is no alarm but an event in the journal. To add an alarm: one entry here, one in the operator's
guide (docs/operate/operators-guide.md, Alarms).
"""

from dataclasses import dataclass
from datetime import timedelta
from enum import StrEnum

from app.base.message import N_, Message, plain, say

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
    title: Message
    consequence: Message
    do: Message
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
            raise ValueError(
                say(
                    "Alarm {code} has priority {priority}; the valid range is 1 to 4.",
                    code=self.code,
                    priority=self.priority,
                )
            )


ENTRIES = (
    Entry(
        "not_stowed", 1, Group.WEATHER, N_("Not stowed"),
        N_("Wind or snow may damage the panel."),
        N_("Remove what blocks the panel, then press Stow panel. If the "
        "panel does not move, keep everyone clear and use the manual control at the cabinet."),
        SHORT, caused_by=(Group.MOTION, Group.DRIVE),
    ),
    Entry(
        "stop_overdue", 1, Group.MOTION, N_("Axes do not stop"),
        N_("The panel is still moving after a stop command."),
        N_("Press the emergency stop at the cabinet, then find the fault in the drive."),
    ),
    Entry(
        "internal_error", 1, Group.MOTION, N_("Controller error: tracker not controlled"),
        N_("This tracker no longer moves, not even to stow in strong wind."),
        N_("Reset the fault. If the fault recurs, keep everyone clear, stow the panel with the "
        "manual control at the cabinet, and send the diagnostics file."),
    ),
    Entry(
        "config_rejected", 2, Group.MOTION, N_("Stored settings rejected"),
        N_("The tracker is at standstill and does not stow. Stored settings that were not "
            "valid were replaced."),
        N_("Compare the stored and used values on the tracker's Settings page, correct and save "
        "them, then set the home position again."),
    ),
    Entry(
        "wrong_direction", 2, Group.MOTION, N_("Axis moves the wrong way"),
        N_("The panel moves away from its target and may reach its mechanical end."),
        N_("Check the motor's phases and the direction set in the drive. Reset the fault, then set "
        "the home position again."),
    ),
    Entry(
        "following_error", 2, Group.MOTION, N_("Axis does not follow"),
        N_("The axis is blocked, or the motor has no torque: no tracking and no stow."),
        N_("Remove what blocks the axis, check the motor and coupling, then reset the fault."),
    ),
    Entry(
        "encoder_jump", 2, Group.MOTION, N_("Position jumped"),
        N_("The true position is unknown: the soft limits do not protect the tracker."),
        N_("Check the encoder and its cable, reset the fault, then set the home position again in step 3."),
    ),
    Entry(
        "limit_switch", 2, Group.MOTION, N_("Limit switch reached"),
        N_("The axis is at its end; the home position may be wrong."),
        N_("Jog the axis away from the switch and check the home position."),
    ),
    Entry(
        "limit_switch_wiring", 2, Group.MOTION, N_("Limit switches contradict each other"),
        N_("The switches do not protect the tracker."),
        N_("Check the wiring of the switches, then reset the fault."),
    ),
    Entry(
        "position_frozen", 2, Group.MOTION, N_("Position frozen"),
        N_("The drive reports motion, but its counter does not change: the true position is unknown."),
        N_("Check the encoder and its cable, reset the fault, then set the home position again in step 3."),
    ),
    Entry(
        "axes_swapped", 2, Group.MOTION, N_("The wrong axis moves"),
        N_("The panel moves in an uncommanded direction: the axes are swapped, or two drives have "
        "the same address."),
        N_("Check the unit ids and the motor cables of both axes, then reset the fault."),
    ),
    Entry(
        "limit_stuck", 2, Group.MOTION, N_("Limit switch stays on"),
        N_("The switch does not protect the tracker and blocks motion in one direction."),
        N_("Check the switch and its cable, then reset the fault."),
    ),
    Entry(
        "over_travel", 2, Group.MOTION, N_("Axis beyond its soft limits"),
        N_("The axis may reach its end; the home position "
            "may be wrong."),
        N_("Find out why the axis did not stop, reset the fault, then set the home "
            "position again in step 3."),
    ),
    Entry(
        "creep", 2, Group.MOTION, N_("Axis moves without a command"),
        N_("The panel drifts, or another master moves it."),
        N_("Keep everyone clear; check the brake, and whether wind or another master moves the axis."),
    ),
    Entry(
        "overrun", 3, Group.MOTION, N_("Stopping distance exceeded"),
        N_("The axis may run into its end or hit a person. It moves slowly until its stopping "
        "distance is short again."),
        N_("Check the brake and load, then repeat the stop test on the Drive tests page."),
    ),
    Entry(
        "supply_voltage", 2, Group.DRIVE, N_("Supply voltage out of range"),
        N_("The tracker is at standstill and does not stow."),
        N_("Check the supply and its cables, then reset the fault."),
    ),
    Entry(
        "move_overdue", 2, Group.MOTION, N_("Move takes too long"),
        N_("The axis is slow or blocked: a stow would also be late."),
        N_("Remove what blocks the axis, then start the move again."),
    ),
    Entry(
        "home_position_not_set", 3, Group.MOTION, N_("Home position not set"),
        N_("Without a home position, the tracker does not track or stow."),
        N_("Read the reason in the journal, then set the home position again in step 3."),
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "home_lost", 2, Group.MOTION, N_("Home reference lost"),
        N_("The tracker does not track or stow until the home position is set again."),
        N_("Compare the panel with the angles shown, then go to step 3, Homing, and set the home position."),
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "fault", 2, Group.MOTION, N_("Stopped with a fault"),
        N_("The tracker is at standstill and does not stow."),
        N_("Read the fault on the tracker's page, remove its cause, then reset the fault."),
    ),
    Entry(
        "drive_fault", 2, Group.DRIVE, N_("Drive reports a fault"),
        N_("The tracker is at standstill and does not stow."),
        N_("Look up the code in the drive's manual, remove the cause, then reset the fault."),
    ),
    Entry(
        "command_refused", 2, Group.DRIVE, N_("Drive refuses its commands"),
        N_("The tracker is at standstill and does not stow."),
        N_("Correct the settings or the drive as described, then reset the fault."),
    ),
    Entry(
        "drive_lost", 2, Group.DRIVE, N_("Drive does not answer"),
        N_("Position unknown: no tracking, no stow. A drive with a watchdog has stopped automatically."),
        N_("Check its power and cable. Heliopanel retries the connection automatically."),
        SHORT,
    ),
    Entry(
        "watchdog_tripped", 3, Group.DRIVE, N_("Drive stopped by its watchdog"),
        N_("The connection or the controller's computer is too slow at times; tracking is interrupted."),
        N_("Check the network and the load on the controller's computer, then press Start tracking."),
    ),
    Entry(
        "drive_restarted", 3, Group.DRIVE, N_("Drive has restarted"),
        N_("The home position of the drive may be lost."),
        N_("Find out why the drive lost its supply. If prompted, set the home position again in step 3."),
    ),
    Entry(
        "drive_elsewhere", 3, Group.DRIVE, N_("Position changed while drive was offline"),
        N_("The home position may be wrong."),
        N_("Compare the angles with the panel. If they differ, set the home position again in step 3."),
    ),
    Entry(
        "stopped_meanwhile", 3, Group.DRIVE, N_("Motion stopped during communication loss"),
        N_("The motion in progress did not finish."),
        N_("Find out why the connection failed, then restart the interrupted motion."),
    ),
    Entry(
        "link_poor", 3, Group.DRIVE, N_("Connection to the drive is poor"),
        N_("Readings fail repeatedly; the connection may be lost soon."),
        N_("Check the cable, shield, termination, and address; see the link quality in the metrics."),
        LONG, LONG, ("drive_lost",),
    ),
    Entry(
        "operator_needed", 3, Group.MOTION, N_("Tracking waits for the operator"),
        N_("No energy is gained by tracking until an operator starts it."),
        N_("Find out why tracking was interrupted, then press Start tracking."),
        SHORT, SHORT, ("drive_lost", "drive_fault", "home_lost"),
    ),
    Entry(
        "wind_sensor_bad", 2, Group.WEATHER, N_("Wind sensor fault"),
        N_("Strong wind would not be detected, or the panel stays stowed."),
        N_("Check the sensor, its cable, and its address; stow the panel if strong wind is forecast."),
        SHORT, LONG,
    ),
    Entry(
        "wind_sensors_disagree", 3, Group.WEATHER, N_("Wind sensors disagree"),
        N_("The higher wind speed is used: the panel may be stowed unnecessarily, or the faulty "
        "sensor may miss a storm."),
        N_("Compare both sensors with the actual wind; check or switch off the faulty one."),
        SHORT, LONG,
    ),
    Entry(
        "snow_sensor_bad", 3, Group.WEATHER, N_("Snow sensor fault"),
        N_("A snow load would not be detected."),
        N_("Check the sensor, its cable, and its address; inspect the panel when it snows."),
        SHORT, LONG,
    ),
    Entry(
        "light_sensor_bad", 4, Group.WEATHER, N_("Irradiance sensor fault"),
        N_("The tracker does not enter low-light hold in the dark, or holds in daylight."),
        N_("Check the sensor, its cable, and its address."),
        SHORT, LONG,
    ),
    Entry(
        "clock_jumped", 3, Group.CLOCK, N_("Clock has jumped"),
        N_("Automatic motion is held until the clock is confirmed or has been stable for 60 s."),
        N_("Compare the clock in the header with a reliable clock and confirm it in step 2."),
    ),
    Entry(
        "clock_implausible", 2, Group.CLOCK, N_("Clock time implausible"),
        N_("No tracking: the sun position is unknown."),
        N_("Set the clock in step 2. If this happens after every start, replace the clock battery."),
    ),
    Entry(
        "clock_drifts", 3, Group.CLOCK, N_("Clock drift"),
        N_("The panel has a small pointing error. Tracking stops at a clock error of 5 minutes."),
        N_("Compare the clock in the header with a reliable clock and set it in step 2. Use NTP to "
        "keep the clock correct."),
    ),
    Entry(
        "clock_differs", 3, Group.CLOCK, N_("Clocks differ"),
        N_("One of two clocks is wrong. If it is the controller's, the panel does not face the sun."),
        N_("Compare both with a third clock, and set the one that is wrong: the controller's in step 2."),
        SHORT, LONG,
    ),
    Entry(
        "clock_off", 2, Group.CLOCK, N_("Clock is minutes off"),
        N_("No tracking: the panel would have a pointing error."),
        N_("Set the clock in step 2. If the sun check reports this although the clock is right, "
        "check the home position."),
    ),
    Entry(
        "zones_missing", 4, Group.CLOCK, N_("Time zones are missing"),
        N_("All times are shown in UTC; tracking is not affected."),
        N_("Install tzdata on the controller's computer, then restart Heliopanel."),
    ),
    Entry(
        "store_behind", 2, Group.STORE, N_("Nothing "
            "can be stored"),
        N_("Tracking continues, but the journal, settings, and recordings are lost if power fails."),
        N_("Free disk space, or check the card and the database. Restart Heliopanel if the "
            "alarm stays active."),
        SHORT, SHORT, ("disk_full",),
    ),
    Entry(
        "store_damaged", 1, Group.STORE, N_("Database damaged"),
        N_("Safe mode: no motion, not even to stow in strong wind; drives can be stopped. "
            "Nothing is recorded."),
        N_("Restore a backup on the Restore page. Keep everyone clear; in strong wind, stow with the "
        "manual control at the cabinet."),
    ),
    Entry(
        "disk_full", 2, Group.STORE, N_("Disk is full"),
        N_("No more samples are recorded; soon the journal and settings cannot be stored either."),
        N_("Delete recordings or other files on the controller's computer now."),
        SHORT, LONG,
    ),
    Entry(
        "disk_low", 3, Group.STORE, N_("Disk is nearly full"),
        N_("Soon nothing can be stored."),
        N_("Delete recordings that are not needed, or other files on the controller's computer."),
        LONG, LONG, ("disk_full",),
    ),
    Entry(
        "overloaded", 3, Group.LOAD, N_("Controller is overloaded"),
        N_("Pages show new values once a second and nothing is recorded; motion and stops stay on time."),
        N_("Close other programs on the controller's computer. If that does not help, use fewer "
        "trackers or a longer period."),
        SOON, SHORT,
    ),
    Entry(
        "ticks_late", 3, Group.LOAD, N_("Control cycle overrun"),
        N_("The controller's computer is overloaded: trackers react late, and jogging may end early."),
        N_("Close other programs on the controller's computer; see the tick lateness in the metrics."),
        SHORT, LONG,
    ),
    Entry(
        "memory_high", 3, Group.LOAD, N_("Controller memory high"),
        N_("At twice its memory limit, the system may end the controller service. Drives then stop; "
        "tracking continues after the restart."),
        N_("Press Stop when tracking can be interrupted for a few seconds: the controller service "
        "then restarts automatically. Afterward, start tracking again."),
        SHORT, LONG,
    ),
    Entry(
        "gateway_down", 4, Group.INTERFACES, N_("An integration is not connected"),
        N_("Other systems receive no data from this site."),
        N_("See Integrations on the Site page for the interface and the cause."),
        LONG, SHORT,
    ),
    Entry(
        "certificate_invalid", 3, Group.INTERFACES, N_("Certificate not valid"),
        N_("Tablets and browsers refuse to open Heliopanel, so that it cannot be stopped from there."),
        N_("Check the clock in step 2: Heliopanel then renews its own certificate automatically. If that "
        "does not help, run heliopanel tls init. Replace any other certificate together with its key."),
        LONG, SHORT, (), (Group.CLOCK,),
    ),
    Entry(
        "certificate_ends", 4, Group.INTERFACES, N_("Certificate expires soon"),
        N_("After its last day, tablets and browsers refuse to open Heliopanel."),
        N_("Run heliopanel tls init if this is Heliopanel's own certificate. Replace any other certificate "
        "together with its key."),
        LONG, SHORT, ("certificate_invalid",),
    ),
    Entry(
        "authority_ends", 3, Group.INTERFACES, N_("Certificate authority at its end"),
        N_("Once it has expired, tablets and browsers refuse to open Heliopanel."),
        N_("Remove the folder tls from the data folder, run heliopanel tls init, and restart Heliopanel. "
        "Then install the new authority on each tablet from the Certificate page."),
        LONG,
    ),
    Entry(
        "notification_failed", 4, Group.INTERFACES, N_("Alarms are not sent"),
        N_("Users away from this screen are not notified of alarms."),
        N_("Open Notifications on the Site page, correct the address, and send a test message."),
    ),
    Entry(
        "alarm_flood", 2, Group.ALARMS, N_("Alarm flood"),
        N_("More than 10 alarms were raised within 10 minutes; priorities 3 and 4 are listed last."),
        N_("Respond to priorities 1 and 2 first, starting with the alarm marked as first."),
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
    title = plain(code.replace("_", " ").capitalize())
    return Entry(
        code, 4, Group.ALARMS, title, N_("No longer known."), N_("No action: this alarm is from the history.")
    )
