"""What the templates of a drive's set-up are given."""

from dataclasses import dataclass
from typing import ClassVar

from app.tracker.config import DriveConfig, TrackerConfig
from app.tracker.drive_check import DriveCheck, DriveChoices
from app.tracker.memory import TrackerMemory
from app.tracker.motion import DriveCapabilities
from app.tracker.proof_states import ProofState
from app.tracker.proofs import ProofMove
from app.tracker.training import Lesson
from app.web.contexts import Form, Frame

Options = tuple[tuple[str, str], ...]
"""Values and texts of a list to choose from."""


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
    """The faults that can be played on a simulated tracker; none on a real one."""

    template: ClassVar[str] = "training.html"

    frame: Frame
    lessons: tuple[Lesson, ...]
    simulated: bool


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
