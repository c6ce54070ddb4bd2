"""The wire form: requests, answers and updates as length-prefixed JSON frames."""

import asyncio
from contextlib import suppress
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, Literal

import orjson
from pydantic import ConfigDict, Discriminator, TypeAdapter
from pydantic_core import to_jsonable_python

from app.alarms.lifecycle import UnknownAlarm
from app.base.message import N_, Message, encoded, told_by
from app.link.messages import (
    MachineUnreachable,
    Order,
    SiteCommand,
    SiteDetail,
    TrackerDetail,
    UnknownRecording,
    UnknownTracker,
    Update,
)
from app.link.metrics import MachineMetrics
from app.tracker.commands.commands import Command, CommandRejected, Jog
from app.tracker.commands.control import refusal
from app.tracker.state.snapshot import Event, SiteSnapshot, Snapshot
from app.tracker.values.alarm_words import AlarmCounts
from app.tracker.values.reason import Reason

LENGTH_BYTES = 4
PLAIN_KEYS_AND_TEXTS = orjson.OPT_NON_STR_KEYS | orjson.OPT_PASSTHROUGH_SUBCLASS
LONGEST_FRAME = 32 * 1024 * 1024
LATE = ConfigDict(defer_build=True)
"""Each process reads one of the two kinds of frames: what reads them is made with the first."""


class FrameBroken(Exception):
    """What came over the wire is not a frame of this protocol; the connection is of no more use."""


@dataclass(frozen=True, slots=True)
class Execute:
    """An `Order` on the wire; `good_until_s` and `given_s` are on the counter that both processes share.

    A jog is good for its lease, so that the way to the machine takes time from it and never adds any.
    """

    number: int
    command: Annotated[Command | SiteCommand, Discriminator("kind")]
    actor: str
    tracker_id: str | None
    key: str | None
    issued_at: datetime | None
    good_until_s: float
    via: str = ""
    address: str = ""
    epoch: int | None = None
    rank: int = 0
    given_s: float | None = None
    do: Literal["execute"] = "execute"

    def order(self, at_s: float) -> Order:
        """Return the order that the panel gave, with what is left of a jog's lease at `at_s`."""
        command = self.command
        if isinstance(command, Jog):
            command = replace(command, lease=min(command.lease, timedelta(seconds=self.good_until_s - at_s)))
        return Order(
            command, self.actor, self.tracker_id, self.key, self.issued_at, self.via, self.address,
            self.epoch, self.rank, self.given_s,
        )  # fmt: skip


@dataclass(frozen=True, slots=True)
class Ask:
    """A question that changes nothing."""

    number: int
    do: Literal["detail", "metrics", "ping", "again"]


@dataclass(frozen=True, slots=True)
class Look:
    """How does this tracker stand, and what may be asked of it?"""

    number: int
    tracker_id: str
    do: Literal["look"] = "look"


@dataclass(frozen=True, slots=True)
class Watch:
    """Somebody looks at these trackers, and at no others."""

    number: int
    tracker_ids: frozenset[str]
    do: Literal["watch"] = "watch"


class ProblemKind(StrEnum):
    """How a request failed."""

    REJECTED = "rejected"
    UNKNOWN_TRACKER = "unknown_tracker"
    UNKNOWN_RECORDING = "unknown_recording"
    UNKNOWN_ALARM = "unknown_alarm"
    INVALID = "invalid"
    FAILED = "failed"


@dataclass(frozen=True, slots=True)
class Problem:
    """A domain error on the wire."""

    kind: ProblemKind
    message: Message
    reasons: tuple[Reason, ...] = ()

    def error(self) -> Exception:
        """Return the exception that the machine raised, or one that says it could not answer."""
        match self.kind:
            case ProblemKind.REJECTED:
                return refusal(*self.reasons)
            case ProblemKind.UNKNOWN_TRACKER:
                return UnknownTracker(self.message)
            case ProblemKind.UNKNOWN_RECORDING:
                return UnknownRecording(self.message)
            case ProblemKind.UNKNOWN_ALARM:
                return UnknownAlarm(self.message)
            case ProblemKind.INVALID:
                return ValueError(self.message)
            case ProblemKind.FAILED:
                return MachineUnreachable(self.message)


@dataclass(frozen=True, slots=True)
class Done:
    """An order was carried out; what its tracker became, None if it has none or changed nothing.

    What else the order changed is told with the snapshot `sequence`, or was before this (None).
    """

    number: int
    tracker: Snapshot | None
    sequence: int | None = None
    tell: Literal["done"] = "done"


@dataclass(frozen=True, slots=True)
class Detailed:
    """The answer to `detail` but for the trackers, which were told before: `tracker_ids` are all of them."""

    number: int
    detail: SiteDetail
    tracker_ids: tuple[str, ...]
    tell: Literal["detail"] = "detail"


@dataclass(frozen=True, slots=True)
class Details:
    """Details of trackers that are not as they were told last, before the answer to `detail`."""

    trackers: dict[str, TrackerDetail]
    tell: Literal["details"] = "details"


@dataclass(frozen=True, slots=True)
class Measured:
    """The answer to `metrics`."""

    number: int
    metrics: MachineMetrics
    tell: Literal["metrics"] = "metrics"


@dataclass(frozen=True, slots=True)
class Pong:
    """The answer to `ping`."""

    number: int
    tell: Literal["pong"] = "pong"


@dataclass(frozen=True, slots=True)
class Refused:
    """A request was not carried out."""

    number: int
    problem: Problem
    tell: Literal["refused"] = "refused"


@dataclass(frozen=True, slots=True)
class Seen:
    """The answer to `look`."""

    number: int
    tracker: Snapshot
    tell: Literal["seen"] = "seen"


@dataclass(frozen=True, slots=True)
class Told:
    """An update that nobody asked for: `site` has the trackers that changed, and alarms if they did.

    `after`, `same_alarms` and `more` are those of `Update`; `tracker_ids` are all trackers, None while none
    came or went.
    """

    site: SiteSnapshot
    events: tuple[Event, ...]
    after: int | None
    tracker_ids: tuple[str, ...] | None
    same_alarms: bool
    more: bool
    tell: Literal["update"] = "update"


Request = Execute | Ask | Look | Watch
Answer = Done | Detailed | Seen | Measured | Pong | Refused
Unasked = Told | Details
Telling = Answer | Unasked

_requests: TypeAdapter[Request] = TypeAdapter(Annotated[Request, Discriminator("do")], config=LATE)
_tellings: TypeAdapter[Telling] = TypeAdapter(Annotated[Telling, Discriminator("tell")], config=LATE)


def ends_motion(request: Request) -> bool:
    """Return whether this is an order to stop: never too late, never one too many."""
    return isinstance(request, Execute) and request.command.spec.ends_motion


def problem_of(error: Exception) -> Problem:
    """Return how an exception of the machine crosses the wire."""
    match error:
        case CommandRejected():
            return Problem(ProblemKind.REJECTED, told_by(error), tuple(error.reasons))
        case UnknownTracker():
            return Problem(ProblemKind.UNKNOWN_TRACKER, told_by(error))
        case UnknownRecording():
            return Problem(ProblemKind.UNKNOWN_RECORDING, told_by(error))
        case UnknownAlarm():
            return Problem(ProblemKind.UNKNOWN_ALARM, told_by(error))
        case MachineUnreachable():
            return Problem(ProblemKind.FAILED, told_by(error))
        case ValueError():
            return Problem(ProblemKind.INVALID, told_by(error))
        case _:
            return Problem(
                ProblemKind.FAILED,
                N_(
                    "The controller service met an unexpected error while it carried this out; "
                    "its log says which. Check the state before you ask again."
                ),
            )


def told(update: Update) -> Told:
    """Return what is to be sent of an update: what differs."""
    site, ids = update.snapshot, None
    if update.arrivals:
        ids = tuple(one.tracker_id for one in site.trackers)
    if update.same_alarms:
        site = replace(site, alarms=(), alarm_counts=AlarmCounts())
    site = replace(site, trackers=update.changed)
    return Told(site, update.events, update.after, ids, update.same_alarms, update.more)


def stop_path(path: Path) -> Path:
    """Return the socket for stops beside the one for everything: no order and no answer is ahead of them."""
    return path.with_suffix(".stop")


def _framed(body: bytes) -> bytes:
    return len(body).to_bytes(LENGTH_BYTES, "big") + body


def encode_request(request: Request) -> bytes:
    """Return one frame with a request."""
    return _framed(_requests.dump_json(request))


def encode_telling(telling: Telling) -> bytes:
    """Return one frame with an answer or an update; this is a sixth of the work that pydantic makes of it."""
    return _framed(orjson.dumps(telling, default=_plain, option=PLAIN_KEYS_AND_TEXTS))


def _plain(value: object) -> object:
    return encoded(value) if isinstance(value, str) else to_jsonable_python(value)


def decode_request(body: bytes) -> Request:
    """Return the request in a frame's body, or raise `FrameBroken`."""
    try:
        return _requests.validate_json(body, strict=True)
    except ValueError as error:
        raise FrameBroken(str(error)) from error


def decode_stop(body: bytes) -> Execute:
    """Return the stop in a frame's body, or raise `FrameBroken`: nothing else comes by the lane for stops."""
    request = decode_request(body)
    if isinstance(request, Execute) and ends_motion(request):
        return request
    raise FrameBroken(f"Only stops come this way, no {request.do}.")


def decode_telling(body: bytes) -> Telling:
    """Return the answer or update in a frame's body, or raise `FrameBroken`."""
    try:
        return _tellings.validate_json(body)
    except ValueError as error:
        with suppress(ValueError):
            return _tellings.validate_python(_in_english(orjson.loads(body)))
        raise FrameBroken(str(error)) from error


def _in_english(told: Any) -> Any:
    """Return what was told with texts for messages: one in the wrong place ends no connection."""
    match told:
        case {"text": str(text), "template": str(), "values": dict()}:
            return text
        case dict():
            return {name: _in_english(value) for name, value in told.items()}
        case list():
            return [_in_english(value) for value in told]
        case _:
            return told


async def read_body(reader: asyncio.StreamReader) -> bytes:
    """Return the body of the next frame; raise `FrameBroken` if it is too long, `EOFError` at the end."""
    length = int.from_bytes(await reader.readexactly(LENGTH_BYTES), "big")
    if length > LONGEST_FRAME:
        raise FrameBroken(f"A frame of {length} bytes is longer than {LONGEST_FRAME}.")
    return await reader.readexactly(length)


async def let_go(writer: asyncio.StreamWriter) -> None:
    """Close a connection at once, whatever is not yet sent, and return when it is closed."""
    writer.transport.abort()
    with suppress(OSError):
        await writer.wait_closed()
