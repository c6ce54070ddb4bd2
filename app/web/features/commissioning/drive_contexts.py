"""What the templates of a drive's set-up are given."""

from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from app.tracker.commissioning.drive_test_states import ProofState
from app.tracker.memory.drive_check import DriveCheck, DriveChoices
from app.tracker.memory.drive_tests import ProofMove
from app.tracker.memory.memory import TrackerMemory
from app.tracker.programs.fault_scenarios import Lesson
from app.tracker.settings.config import DriveConfig, TrackerConfig
from app.tracker.values.motion import DriveCapabilities
from app.web.shell.contexts import Form, Frame

Options = tuple[tuple[str, str], ...]
"""Values and texts of a list to choose from."""


class TrainingPlace(StrEnum):
    """Where the faults of a tracker are played: in this program, in drive-sim, or not at all."""

    HERE = "here"
    DRIVE_SIM = "drive-sim"
    NOWHERE = "nowhere"


@dataclass(frozen=True, slots=True)
class DrivePage:
    """How a tracker's drive is reached and what hangs on it; `check` is the newest look at it.

    `stored` are the saved settings; `tested` says that this is the answer to a test.
    """

    template: ClassVar[str] = "drive.html"

    frame: Frame
    form: Form
    choices: DriveChoices
    profiles: Options
    ports: Options
    kinds: Options
    check: DriveCheck | None
    stored: DriveConfig
    capabilities: DriveCapabilities | None
    can_undo: bool
    done: str
    tested: bool = False


@dataclass(frozen=True, slots=True)
class TrainingPage:
    """The faults that can be played on a tracker by their subjects; none on one that may be real.

    `place` says where they are played; `weather_is` whether the site's weather is made up (None: it cannot
    be, because a tracker of the site may be real), and `playing` what is played with it.
    """

    template: ClassVar[str] = "training.html"

    frame: Frame
    place: TrainingPlace
    lessons: dict[str, tuple[Lesson, ...]]
    weather_is: bool | None
    playing: str
    real_trackers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ProofsPage:
    """What is proven at the machine, one kind after the other."""

    template: ClassVar[str] = "proofs.html"

    frame: Frame
    config: TrackerConfig
    memory: TrackerMemory
    capabilities: DriveCapabilities | None
    states: dict[str, tuple[ProofState, ...]]
    move: ProofMove | None
    question: str
    form: Form
    left: int
