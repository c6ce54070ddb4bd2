"""The words that travel as values (a mode, an activity, an order) and that people read as labels."""

from collections.abc import Iterable, Iterator
from enum import Enum
from typing import IO

from app.access.principal import Via
from app.access.roles import Role
from app.access.sessions import SessionState
from app.access.tokens import Scope
from app.alarms.catalogue import Group
from app.alarms.lifecycle import Happened
from app.energy.plane import Transposition
from app.link.metrics import GatewayStatus
from app.link.orders import KINDS
from app.studies.folder import StudyStatus
from app.studies.jobs import ProgramLight
from app.studies.request import Fidelity, LightModel, Span, StudyMode, StudyStrategy
from app.sun.accuracy import Sight
from app.sun.algorithms import Algorithm
from app.sun.events import PolarDay
from app.tracker.access.interlocks import Action
from app.tracker.commissioning.alignment import Mistake
from app.tracker.commissioning.steps import StepStatus
from app.tracker.memory.drive_check import CheckOutcome
from app.tracker.memory.drive_tests import AxisEnd, LinkLossOutcome, ProofKind, StopSpeed
from app.tracker.memory.memory import StepName
from app.tracker.memory.recording import RecordingKind
from app.tracker.motion.hybrid import HybridPhase
from app.tracker.programs.fault_scenarios import Subject
from app.tracker.protections.words import Protection
from app.tracker.settings.axes import Axis, JogSpeed
from app.tracker.settings.config import DriveKind, MountKind, NightBehaviour, Parity
from app.tracker.settings.mechanics import FaultClass, Recovery
from app.tracker.settings.protections import Facing, Reaction, StowName
from app.tracker.settings.stepped import StepFrame, TimeBase
from app.tracker.settings.strategy import IntervalAim
from app.tracker.state.activity import MoveKind, TrackPhase
from app.tracker.state.snapshot import ActivityName, EventKind, ShowPhase
from app.tracker.values.alarm_words import AlarmState
from app.tracker.values.mode import Mode
from app.tracker.values.motion import RequestKind
from app.tracker.values.notifications import Channel
from app.tracker.values.operator_message import StateWord
from app.tracker.weather.simulated_weather import Scenario, WeatherFault
from app.tracker.weather.weather import Quality, Quantity
from app.web.features.commissioning.drive_contexts import TrainingPlace
from app.web.features.control.control_api import ControlAction
from app.web.features.records import record_words
from app.web.features.records.signatures import SignatureRole
from app.web.features.shows.shows_api import ShowAction
from app.web.http.problems import phrase
from app.web.languages.known import in_words
from app.web.shell.control_role import Standing

SHOWN: tuple[type[Enum], ...] = (
    Via,
    Role,
    SessionState,
    Scope,
    Group,
    Happened,
    Transposition,
    GatewayStatus,
    StudyStatus,
    ProgramLight,
    Fidelity,
    LightModel,
    Span,
    StudyMode,
    StudyStrategy,
    Sight,
    Algorithm,
    PolarDay,
    MoveKind,
    TrackPhase,
    AlarmState,
    Axis,
    Mistake,
    JogSpeed,
    StepStatus,
    DriveKind,
    MountKind,
    NightBehaviour,
    Parity,
    CheckOutcome,
    AxisEnd,
    LinkLossOutcome,
    ProofKind,
    StopSpeed,
    StepName,
    Subject,
    HybridPhase,
    Action,
    Mode,
    RequestKind,
    Channel,
    StepFrame,
    TimeBase,
    FaultClass,
    Recovery,
    Facing,
    Protection,
    Reaction,
    StowName,
    RecordingKind,
    Scenario,
    WeatherFault,
    ActivityName,
    StateWord,
    EventKind,
    ShowPhase,
    IntervalAim,
    Quality,
    Quantity,
    ControlAction,
    ShowAction,
    Standing,
    TrainingPlace,
    SignatureRole,
)
"""The enumerations whose members a page, a record or a message shows."""

_ACCESS = """
    user_added roles_changed password_changed user_removed token_made token_revoked session_ended
    factory_reset stepped_up log_in refused_log_in refused_token refused_foreign refused_stops
    refusals_left_out network_tried network_kept network_rolled_back network_not_served"""
_OTHERS = "Completed Stopped Interrupted manual system unset flat"
PHRASES = (400, 401, 403, 404, 405, 409, 413, 422, 423, 429, 500, 503)


def words() -> Iterator[str]:
    """Return every word as the catalogues have it."""
    for kind in SHOWN:
        yield from (in_words(one.value) for one in kind)
    yield from map(in_words, (*KINDS, *_ACCESS.split()))
    yield from _OTHERS.split()
    yield from map(phrase, PHRASES)


def extract(
    _file: IO[bytes], _keywords: object, _comments: object, **_options: object
) -> Iterable[tuple[int, str, object, list[str]]]:
    """Tell Babel every word, each once, and what a record says by itself."""
    for text in dict.fromkeys(words()):
        yield 0, "N_", text, []
    for text in dict.fromkeys(record_words.TEXTS):
        yield 0, "pgettext", (record_words.CONTEXT, text), []
