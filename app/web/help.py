"""Help in place: what a page is for, what can go wrong there, its picture, and where the guide says more."""

import re
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Help:
    """The help of one page; `picture` names a drawing of `_help_pictures.html`, `guide` an anchor."""

    title: str
    purpose: str
    picture: str
    wrong: tuple[str, ...]
    guide: str


STEP = r"/trackers/[^/]+/commissioning/"
TRACKER = r"/trackers/[^/]+"

PAGES: tuple[tuple[str, Help], ...] = (
    (
        STEP + "location",
        Help(
            "Location",
            "The controller works out where the sun stands from the latitude and longitude of the site. "
            "One hundredth of a degree, about a kilometre, is near enough.",
            "globe",
            (
                "A lost minus sign or W instead of E puts the site on the other side of the Earth: look at "
                "the cross on the map and at today's sunrise.",
                "Swapped numbers: latitude is how far north or south, longitude how far east or west.",
                "A location that changes later makes later steps to be confirmed.",
            ),
            "1-location",
        ),
    ),
    (
        STEP + "clock",
        Help(
            "Clock",
            "The sun moves by one degree in four minutes. A clock that is a minute wrong turns the panel a "
            "quarter of a degree off the sun.",
            "shadow",
            (
                "The time is right but the zone is wrong: then the shadow points elsewhere by 15° an hour.",
                "A tablet's own clock may be wrong, too: compare it with a telephone.",
                "Without NTP the clock drifts; come back to this step at every visit.",
            ),
            "2-clock",
        ),
    ),
    (
        STEP + "homing",
        Help(
            "Homing",
            "The drive counts from where you say that zero is: panel upright, its face to true north. All "
            "later angles count from there.",
            "north",
            (
                "A compass shows magnetic north, which may be 10° and more off; the sun check finds that.",
                "The panel turns the wrong way: prove the drive before you set the zero.",
                "The key works only while it is held. A link that is too slow ends the motion by itself.",
            ),
            "3-homing",
        ),
    ),
    (
        STEP + "mode(/orientation)?",
        Help(
            "Mode",
            "What the tracker does from sunrise to sunset: follow the sun with both axes, with one, or stand "
            "still at an angle of your choice.",
            "modes",
            (
                "An angle beyond the soft limits is refused; the limits are among the settings.",
                "Go moves the panel: keep people clear of it.",
                "The step is done only when the panel has arrived.",
            ),
            "4-mode",
        ),
    ),
    (
        STEP + "run",
        Help(
            "Run",
            "Everything before is checked once more. Then tracking begins, or you show any day accelerated.",
            "run",
            (
                "A drive that lost its supply since homing is not homed: the page sends you back to step 3.",
                "At night tracking waits for sunrise; that is no fault.",
                "STOP ends it at once. It is not an emergency stop.",
            ),
            "5-run",
        ),
    ),
    (
        TRACKER + "/settings",
        Help(
            "Settings",
            "How far and how fast the axes may turn, how near the sun is near enough, and where the panel "
            "stands when it is parked.",
            "limits",
            (
                "Soft limits beyond the machine's ends: the axis runs into its limit switch.",
                "A speed above what the drive can do: the axis falls behind and stops with a fault.",
                "Wrong value saved: Undo the last change brings the former settings back.",
            ),
            "settings-of-a-tracker",
        ),
    ),
    (
        TRACKER + "/drive",
        Help(
            "Drive",
            "The drive is reached by its profile, its address and its unit id. Testing the connection reads "
            "everything and changes nothing.",
            "wire",
            (
                "Nothing answers: power, cable, address.",
                "Something answers that is no drive of this profile: another unit id or another profile.",
                "Saving another drive loses the zero.",
            ),
            "connect-it",
        ),
    ),
    (
        TRACKER + "/proofs",
        Help(
            "Prove the drive",
            "What the controller believes of the machine is tried at the machine: the way an axis turns, how "
            "far, how quickly it stops, and what it does when nobody tells it anything.",
            "turn",
            (
                "These motions are real. Somebody stands there who reaches the hard-wired stop.",
                "After another motor, gear or drive the proofs are to be made again.",
                "Without a watchdog of its own a drive goes on when the controller dies.",
            ),
            "prove-it",
        ),
    ),
    (
        TRACKER + "/mount",
        Help(
            "Mount",
            "How the panel hangs on its axes. The same sun needs other angles on another mount.",
            "modes",
            (
                "A changed mount is another machine: zero and limits are to be looked at again.",
                "Rows shade each other when the sun is low: backtracking turns them flatter then.",
            ),
            "the-drive",
        ),
    ),
    (
        TRACKER + "/strategy",
        Help(
            "Strategy",
            "When the panel moves: all the time, in small steps when it is off by a deadband, or by a "
            "program of times and angles.",
            "steps",
            (
                "Steps that are too large lose energy; try a day before you save.",
                "A step program is for one place and season.",
            ),
            "what-tracking-is-worth",
        ),
    ),
    (
        TRACKER + "/protections",
        Help(
            "Protections",
            "Strong wind lays the panel flat, snow tips it, darkness lets it rest. The limits of that stand "
            "here.",
            "wind",
            (
                "A protection without a sensor does nothing: the page says so.",
                "A limit that is too low stows all day long; one that is too high breaks the panel.",
                "By hand, with a fault or without a trusted zero nothing is stowed by itself.",
            ),
            "protections",
        ),
    ),
    (
        TRACKER + "/sun-check",
        Help(
            "Sun check",
            "The sun is the best instrument there is: where its shadow vanishes, the panel faces it.",
            "shadow",
            (
                "One sighting finds a coarse mistake; three or more over a day correct it.",
                "The clock must be right first.",
            ),
            "sun-check",
        ),
    ),
    (
        TRACKER + "/record",
        Help(
            "Record",
            "Proves how the tracker was left: settings, proofs, who and when. Signed, it is kept for good.",
            "paper",
            (
                "Sign only when every step is done: what is still open stands in the record as well.",
                "Photos are added before signing.",
            ),
            "the-record",
        ),
    ),
    (
        "/site",
        Help(
            "Site",
            "What all trackers share: the weather and where it comes from, how it is judged, and other "
            "systems that are connected.",
            "wind",
            (
                "A station that is not reached leaves the protections without a sensor.",
                "Simulated weather is for trying: it is refused where a tracker is real.",
            ),
            "how-the-weather-is-judged",
        ),
    ),
    (
        "/site/notifications",
        Help(
            "Notifications",
            "Alarms also go to people who are not at a screen, by webhook or e-mail.",
            "wire",
            ("Send a test message after every change.", "What is not sent is itself an alarm."),
            "alarms",
        ),
    ),
)
_patterns = tuple((re.compile(pattern), entry) for pattern, entry in PAGES)


def help_for(path: str) -> Help | None:
    """Return the help of the page at a path, None where it needs none."""
    return next((entry for pattern, entry in _patterns if pattern.fullmatch(path)), None)
