"""Help in place: what a page is for, what can go wrong there, its picture, and where the guide says more."""

import re
from dataclasses import dataclass

from app.base.message import N_, Message


@dataclass(frozen=True, slots=True)
class Help:
    """The help of one page; `picture` names a drawing of `_help_pictures.html`, `guide` an anchor."""

    title: str
    purpose: Message
    picture: str
    wrong: tuple[str, ...]
    guide: str


STEP = r"/trackers/[^/]+/commissioning/"
TRACKER = r"/trackers/[^/]+"

PAGES: tuple[tuple[str, Help], ...] = (
    (
        STEP + "location",
        Help(
            N_("Location"),
            N_(
                "The controller calculates the sun's position from the latitude and longitude of the "
                "site. An accuracy of one hundredth of a degree, about one kilometer, is sufficient."
            ),
            "globe",
            (
                N_(
                    "A missing minus sign, or W instead of E, puts the site on the other side of the "
                    "Earth: check the map and the sun now."
                ),
                N_("Swapped numbers: latitude is how far north or south, longitude how far east or west."),
                N_("Changing the location later means that later steps must be confirmed again."),
            ),
            "1-location",
        ),
    ),
    (
        STEP + "clock",
        Help(
            N_("Clock"),
            N_(
                "The sun moves by one degree in four minutes. A clock error of one minute causes a "
                "pointing error of a quarter of a degree."
            ),
            "shadow",
            (
                N_(
                    "The time is correct but the time zone is wrong: the shadow direction is then off "
                    "by 15° per hour."
                ),
                N_("A tablet's own clock may also be wrong: compare it with a phone."),
                N_("Without NTP, the clock drifts; repeat this step at every visit."),
            ),
            "2-clock",
        ),
    ),
    (
        STEP + "homing",
        Help(
            N_("Homing"),
            N_("The drive measures all angles from the home position: panel vertical, facing true north."),
            "north",
            (
                N_(
                    "A compass shows magnetic north, which can be off by 10° or more; the sun check "
                    "detects this error."
                ),
                N_("The panel turns the wrong way: run the drive tests before you set the home position."),
                N_(
                    "A hold-to-run button works only while it is held. A connection that is too slow "
                    "ends the motion automatically."
                ),
            ),
            "3-homing",
        ),
    ),
    (
        STEP + "mode(/orientation)?",
        Help(
            N_("Mode"),
            N_(
                "What the tracker does from sunrise to sunset: follow the sun with both axes or with "
                "one axis, or hold a fixed angle."
            ),
            "modes",
            (
                N_("An angle beyond the soft limits is refused; the limits are on the Settings page."),
                N_("Go moves the panel: keep everyone clear of it."),
                N_("The step is done only when the panel is in position."),
            ),
            "4-mode",
        ),
    ),
    (
        STEP + "run",
        Help(
            N_("Start"),
            N_(
                "All previous steps are checked again. Then start tracking, or show the tracking "
                "movement of any day at higher speed."
            ),
            "run",
            (
                N_("A drive that has lost power since homing is not homed: the page returns you to step 3."),
                N_("At night, the tracker holds until sunrise; this is not a fault."),
                N_("STOP ends the motion immediately. STOP is not an emergency stop."),
            ),
            "5-start",
        ),
    ),
    (
        TRACKER + "/settings",
        Help(
            N_("Settings"),
            N_("Travel limits and speeds of the axes, pointing tolerance, and park position."),
            "limits",
            (
                N_("Soft limits beyond the mechanical travel: the axis runs into its limit switch."),
                N_("A speed above the capability of the drive: the axis lags and stops with a fault."),
                N_("Wrong value saved: Undo the last change restores the previous settings."),
            ),
            "settings-of-a-tracker",
        ),
    ),
    (
        TRACKER + "/drive",
        Help(
            N_("Drive"),
            N_(
                "The drive is reached by its profile, address, and unit ID. Testing the connection "
                "reads everything and changes nothing."
            ),
            "wire",
            (
                N_("No answer: check power, cable, and address."),
                N_("A device that does not match this profile answers: check the unit ID and the profile."),
                N_("Saving another drive loses the home reference."),
            ),
            "connect-the-drive",
        ),
    ),
    (
        TRACKER + "/drive-tests",
        Help(
            N_("Drive tests"),
            N_(
                "The drive tests check the controller's settings at the tracker: direction, scale, "
                "limits, stop, and communication loss."
            ),
            "turn",
            (
                N_(
                    "These motions are real. A person must watch the tracker within reach of the "
                    "emergency stop."
                ),
                N_("After a change of motor, gear, or drive, repeat the drive tests."),
                N_("A drive without its own watchdog continues to move when the controller fails."),
            ),
            "drive-tests",
        ),
    ),
    (
        TRACKER + "/mount",
        Help(
            N_("Mount"),
            N_(
                "How the panel is mounted on its axes. The same sun position needs other axis angles "
                "on another mount."
            ),
            "modes",
            (
                N_("After a change of mount, check the home position and the limits again."),
                N_("Rows shade each other when the sun is low: backtracking then turns the panels flatter."),
            ),
            "the-drive",
        ),
    ),
    (
        TRACKER + "/strategy",
        Help(
            N_("Strategy"),
            N_(
                "When the panel moves: continuously, when the pointing error exceeds a deadband, or "
                "by a program of times and angles."
            ),
            "steps",
            (
                N_("Steps that are too large lose energy; simulate a day before you save."),
                N_("A step program suits only one location and season."),
            ),
            "energy-studies",
        ),
    ),
    (
        TRACKER + "/protections",
        Help(
            N_("Protections"),
            N_(
                "Wind stow, snow stow, and low-light hold protect the tracker. Their thresholds are set here."
            ),
            "wind",
            (
                N_("A protection without a sensor has no effect: the page shows this."),
                N_(
                    "A threshold that is too low stows the panel all day; one that is too high can "
                    "damage the panel."
                ),
                N_(
                    "In manual operation, with a fault, or when not homed, the tracker does not stow "
                    "automatically."
                ),
            ),
            "protections",
        ),
    ),
    (
        TRACKER + "/sun-check",
        Help(
            N_("Sun check"),
            N_(
                "The sun is the most accurate reference: where a stick square to the panel casts no "
                "shadow, the panel faces the sun."
            ),
            "shadow",
            (
                N_("One sighting finds a large error; three or more over a day correct the pointing."),
                N_("The clock must be correct first."),
            ),
            "sun-check",
        ),
    ),
    (
        TRACKER + "/record",
        Help(
            N_("Record"),
            N_(
                "Documents the state of the tracker: settings, drive tests, names, and dates. A "
                "signed record is kept permanently."
            ),
            "paper",
            (
                N_("Sign only when every step is done: open items are part of the record as well."),
                N_("Photos are added before signing."),
            ),
            "commissioning-record",
        ),
    ),
    (
        "/site",
        Help(
            N_("Site"),
            N_(
                "Settings shared by all trackers: weather sources, weather evaluation, and connected systems."
            ),
            "wind",
            (
                N_("If the weather station is not reached, the protections have no sensor."),
                N_("Simulated weather is for tests: it is refused where a tracker is real."),
            ),
            "weather-evaluation",
        ),
    ),
    (
        "/site/notifications",
        Help(
            N_("Notifications"),
            N_("Alarms are also sent to users who are not at a screen, by webhook or e-mail."),
            "wire",
            (
                N_("Send a test message after every change."),
                N_("A notification that cannot be sent raises an alarm."),
            ),
            "alarms",
        ),
    ),
)
_patterns = tuple((re.compile(pattern), entry) for pattern, entry in PAGES)


def help_for(path: str) -> Help | None:
    """Return the help of the page at a path, None where it needs none."""
    return next((entry for pattern, entry in _patterns if pattern.fullmatch(path)), None)
