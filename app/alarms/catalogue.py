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
    DOORS = "doors"
    ALARMS = "alarms"


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
            raise ValueError(f"The alarm {self.code} has the priority {self.priority}; there are 1 to 4.")


ENTRIES = (
    Entry(
        "not_stowed", 1, Group.WEATHER, "Not stowed",
        "Wind or snow may damage the panel.",
        "Find out what holds it, press Stow; if it does not move, keep people away and stow it by hand.",
        SHORT, caused_by=(Group.MOTION, Group.DRIVE),
    ),
    Entry(
        "stop_overdue", 1, Group.MOTION, "Axes do not stop",
        "The panel moves although it was told to stop.",
        "Press the emergency stop at the cabinet, then look for the fault in the drive.",
    ),
    Entry(
        "internal_error", 1, Group.MOTION, "Tracker without control",
        "Nothing moves this tracker any more, not even for wind.",
        "Reset the fault; if it comes again, stow the panel by hand and send the diagnostics file.",
    ),
    Entry(
        "config_rejected", 2, Group.MOTION, "Stored settings rejected",
        "The tracker stands still and does not stow; where stored settings did not fit, others hold.",
        "Compare both on the tracker's Settings page, correct them, save, and set the zero again.",
    ),
    Entry(
        "wrong_direction", 2, Group.MOTION, "Axis moves the wrong way",
        "The panel turns away from where it should go and may reach its end.",
        "Check the motor's phases and the direction set in the drive, clear the fault, set the zero again.",
    ),
    Entry(
        "following_error", 2, Group.MOTION, "Axis does not follow",
        "Something blocks the axis, or the motor does not pull: no tracking and no stow.",
        "Look for what blocks the axis, check motor and coupling, then clear the fault.",
    ),
    Entry(
        "encoder_jump", 2, Group.MOTION, "Position jumped",
        "The true position is not known: the soft limits do not protect.",
        "Check the encoder and its cable, clear the fault, set the zero again in step 3.",
    ),
    Entry(
        "limit_switch", 2, Group.MOTION, "Limit switch reached",
        "The axis is at its end; the zero may be wrong.",
        "Move it away from the switch by hand and check the zero.",
    ),
    Entry(
        "limit_switch_wiring", 2, Group.MOTION, "Limit switches contradict each other",
        "The switches do not protect the machine.",
        "Check the wiring of the switches, then clear the fault.",
    ),
    Entry(
        "position_frozen", 2, Group.MOTION, "Position frozen",
        "The drive says that it turns, its counter stands: the true position is not known.",
        "Check the encoder and its cable, clear the fault, set the zero again in step 3.",
    ),
    Entry(
        "axes_swapped", 2, Group.MOTION, "The wrong axis moves",
        "The panel turns where nobody sent it: axes swapped, or two drives have one address.",
        "Check the unit ids and the motor cables of both axes, then clear the fault.",
    ),
    Entry(
        "limit_stuck", 2, Group.MOTION, "Limit switch stays on",
        "The switch does not protect the machine, and bars the way to one side.",
        "Check the switch and its cable, then clear the fault.",
    ),
    Entry(
        "over_travel", 2, Group.MOTION, "Axis beyond its soft limits",
        "The axis may reach its end; the zero may be wrong.",
        "Find out why it went on, clear the fault, set the zero again in step 3.",
    ),
    Entry(
        "creep", 2, Group.MOTION, "Axis moves without a command",
        "The panel drifts, or somebody else moves it.",
        "Keep people away; check the brake, and whether wind or another master moves the axis.",
    ),
    Entry(
        "overrun", 3, Group.MOTION, "Axis stops too late",
        "It may run into its end or into somebody; it moves slowly until its stops are short again.",
        "Check brake and load, then measure the stop again on the page Proofs.",
    ),
    Entry(
        "supply_voltage", 2, Group.DRIVE, "Supply voltage out of range",
        "The tracker stands still and does not stow.",
        "Check the supply and its cables, then clear the fault.",
    ),
    Entry(
        "move_overdue", 2, Group.MOTION, "Move takes too long",
        "The axis is slow or blocked: a stow would be late, too.",
        "Look for what blocks the axis, then start the move again.",
    ),
    Entry(
        "zero_failed", 3, Group.MOTION, "Zero was not set",
        "Without a zero the tracker does not track and does not stow.",
        "Read why in the journal, then set the zero again in step 3.",
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "home_lost", 2, Group.MOTION, "Zero is no longer trusted",
        "The tracker neither tracks nor stows until the zero is set again.",
        "Compare the panel with the angles shown, then go to step 3, Homing, and set the zero.",
        suppressed_by=("drive_lost",),
    ),
    Entry(
        "fault", 2, Group.MOTION, "Stopped with a fault",
        "The tracker stands still and does not stow.",
        "Read the fault on the tracker's page, remove its cause, then reset it.",
    ),
    Entry(
        "drive_fault", 2, Group.DRIVE, "Drive reports a fault",
        "The tracker stands still and does not stow.",
        "Look the code up in the drive's manual, remove the cause, then clear the fault.",
    ),
    Entry(
        "drive_lost", 2, Group.DRIVE, "Drive does not answer",
        "Position unknown: no tracking, no stow. A drive with a watchdog has stopped by itself.",
        "Check its power and its cable; it is tried again by itself.",
        SHORT,
    ),
    Entry(
        "watchdog_tripped", 3, Group.DRIVE, "Drive stopped by its watchdog",
        "The connection or this computer is too slow at times; tracking is interrupted.",
        "Check the network and the load of the computer, then press Start tracking.",
    ),
    Entry(
        "drive_restarted", 3, Group.DRIVE, "Drive has restarted",
        "Its zero may be lost.",
        "Find out why it lost its supply; set the zero again in step 3 if that is asked for.",
    ),
    Entry(
        "drive_elsewhere", 3, Group.DRIVE, "Drive stands elsewhere than before",
        "The zero may be wrong.",
        "Compare its angles with the panel, and set the zero again in step 3 if they differ.",
    ),
    Entry(
        "stopped_meanwhile", 3, Group.DRIVE, "Drive stopped while it was lost",
        "The motion that was under way did not finish.",
        "Find out why the connection failed, then start what was interrupted.",
    ),
    Entry(
        "link_poor", 3, Group.DRIVE, "Connection to the drive is poor",
        "Readings fail again and again; it may be lost soon.",
        "Check cable, shield, termination and address; see the link quality in the metrics.",
        LONG, LONG, ("drive_lost",),
    ),
    Entry(
        "operator_needed", 3, Group.MOTION, "Tracking waits for the operator",
        "No energy is gained by tracking until somebody starts it.",
        "Find out why it was interrupted, then press Start tracking.",
        SHORT, SHORT, ("drive_lost", "drive_fault", "home_lost"),
    ),
    Entry(
        "wind_sensor_bad", 2, Group.WEATHER, "Wind sensor fails",
        "Strong wind would not be noticed, or the panel stays stowed.",
        "Check the sensor, its cable and its address; stow the panel if strong wind is forecast.",
        SHORT, LONG,
    ),
    Entry(
        "wind_sensors_disagree", 3, Group.WEATHER, "Wind sensors disagree",
        "The higher wind counts: the panel may be stowed without need, or the other sensor hides a storm.",
        "Compare both sensors with the wind outside; check or switch off the one that is wrong.",
        SHORT, LONG,
    ),
    Entry(
        "snow_sensor_bad", 3, Group.WEATHER, "Snow sensor fails",
        "A load of snow would not be noticed.",
        "Check the sensor, its cable and its address; look at the panel when it snows.",
        SHORT, LONG,
    ),
    Entry(
        "light_sensor_bad", 4, Group.WEATHER, "Light sensor fails",
        "The tracker does not rest in the dark, or rests in the light.",
        "Check the sensor, its cable and its address.",
        SHORT, LONG,
    ),
    Entry(
        "clock_jumped", 3, Group.CLOCK, "Clock has jumped",
        "Automatic motion waits until the clock is confirmed or has been stable for 60 s.",
        "Compare the clock in the header with a good one and confirm it in step 2.",
    ),
    Entry(
        "clock_implausible", 2, Group.CLOCK, "Clock cannot be right",
        "Nothing tracks: the sun's place is not known.",
        "Set the clock in step 2; if it happens after every start, change the battery of the clock.",
    ),
    Entry(
        "clock_drifts", 3, Group.CLOCK, "Clock runs away",
        "The panel points a little beside the sun; from 5 minutes on nothing tracks any more.",
        "Compare the clock in the header with a good one and set it in step 2; let NTP keep it.",
    ),
    Entry(
        "clock_off", 2, Group.CLOCK, "Clock is minutes off",
        "Nothing tracks: the panel would point beside the sun.",
        "Set the clock in step 2; if the sun check says so but the clock is right, check the zero.",
    ),
    Entry(
        "zones_missing", 4, Group.CLOCK, "Time zones are missing",
        "All times are shown in UTC; tracking is not concerned.",
        "Install tzdata on this computer, then restart Heliopanel.",
    ),
    Entry(
        "store_behind", 2, Group.STORE, "Nothing can be stored",
        "Tracking goes on, but journal, settings and recordings are lost at a power cut.",
        "Free the disk or check the card and the database; then restart if it does not end by itself.",
        SHORT, SHORT, ("disk_full",),
    ),
    Entry(
        "store_damaged", 1, Group.STORE, "Database damaged",
        "Safe mode: nothing moves, not even for wind; drives can be stopped. Nothing is recorded.",
        "Restore a backup on the page Restore; keep people away, and stow by hand if strong wind comes.",
    ),
    Entry(
        "disk_full", 2, Group.STORE, "Disk is full",
        "No samples are recorded any more; soon journal and settings cannot be stored either.",
        "Delete recordings or other files on this computer now.",
        SHORT, LONG,
    ),
    Entry(
        "disk_low", 3, Group.STORE, "Disk is nearly full",
        "Soon nothing can be stored.",
        "Delete recordings that are not needed, or other files on this computer.",
        LONG, LONG, ("disk_full",),
    ),
    Entry(
        "overloaded", 3, Group.LOAD, "Controller is overloaded",
        "Pages show new values once a second and nothing is recorded; motion and stops stay on time.",
        "Close what else runs on this computer; use fewer trackers or a longer period if that does not help.",
        SOON, SHORT,
    ),
    Entry(
        "ticks_late", 3, Group.LOAD, "Control is late",
        "The computer is overloaded: trackers react late, hand motion may end early.",
        "Close what else runs on this computer; see the tick lateness in the metrics.",
        SHORT, LONG,
    ),
    Entry(
        "memory_high", 3, Group.LOAD, "Memory runs short",
        "At twice its limit the system may end the controller service; drives stop then, tracking goes on "
        "after its restart.",
        "Press Stop when the site can do without tracking for seconds: the controller service then starts "
        "again by itself. Afterwards start tracking again.",
        SHORT, LONG,
    ),
    Entry(
        "gateway_down", 4, Group.DOORS, "An integration is not connected",
        "Other systems do not hear of this site.",
        "Look at the page Site, Integrations: it says which one and why.",
        LONG, SHORT,
    ),
    Entry(
        "notification_failed", 4, Group.DOORS, "Alarms are not sent",
        "Who is not at this screen does not hear of alarms.",
        "Look at the page Site, Notifications; correct the address and send a test message.",
    ),
    Entry(
        "alarm_flood", 2, Group.ALARMS, "Flood of alarms",
        "More than 10 alarms came within 10 minutes; priorities 3 and 4 stand behind the others.",
        "Deal with priority 1 and 2 first, beginning with what is marked as first.",
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
    return Entry(code, 4, Group.ALARMS, title, "Not known any more.", "Nothing: this alarm is history.")
