"""What went over a bus, as JSON lines: one request and its answer a line. A trace can be played again."""

import json
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from app.base.clock import Clock
from app.base.message import N_, say
from app.modbus.errors import DriveError
from app.modbus.server import ILLEGAL_ADDRESS, Refusal
from app.modbus.wire import Ask, Broken, Refused, Timing, Unanswered, Wire


@dataclass(frozen=True, slots=True)
class Exchange:
    """One request and what came of it: words, a Modbus exception, silence, or a reply that was no good."""

    at_s: float
    ask: Ask
    reply: tuple[int, ...] = ()
    refused: int | None = None
    silent: bool = False
    broken: str = ""

    def line(self) -> str:
        """Return this exchange as a line of a trace."""
        told: dict[str, Any] = {"at_s": round(self.at_s, 4), "unit": self.ask.unit}
        if self.ask.words:
            told["write"] = [self.ask.address, list(self.ask.words)]
        else:
            told["read"] = [self.ask.address, self.ask.count]
        told["reply"] = list(self.reply)
        faults = {"refused": self.refused, "silent": self.silent or None, "broken": self.broken or None}
        return json.dumps(told | {name: value for name, value in faults.items() if value is not None})

    def words(self) -> list[int]:
        """Return the words of the reply, or raise what happened instead."""
        if self.refused is not None:
            raise Refused(self.refused)
        if self.silent:
            raise Unanswered
        if self.broken:
            raise Broken(self.broken)
        return list(self.reply)


def parse_trace(lines: Iterable[str], name: str) -> list[Exchange]:
    """Return the exchanges of a trace, or raise `DriveError` with the line that is none."""
    found = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            found.append(_exchange(json.loads(line)))
        except (ValueError, KeyError, TypeError) as error:
            raise DriveError(
                say(
                    "{name}, line {number}: this is not a line of a bus trace. Record a trace with "
                    "heliopanel drive record.",
                    name=name,
                    number=number,
                )
            ) from error
    if not found:
        raise DriveError(
            say("{name} contains no exchange. Record a trace with heliopanel drive record.", name=name)
        )
    return found


def _exchange(told: dict[str, Any]) -> Exchange:
    unit = int(told["unit"])
    if "write" in told:
        address, words = told["write"]
        ask = Ask(unit, int(address), len(words), tuple(int(word) for word in words))
    else:
        address, count = told["read"]
        ask = Ask(unit, int(address), int(count))
    refused = told.get("refused")
    return Exchange(
        float(told["at_s"]),
        ask,
        tuple(int(word) for word in told["reply"]),
        None if refused is None else int(refused),
        bool(told.get("silent", False)),
        str(told.get("broken", "")),
    )


class RecordingWire:
    """Passes everything on to a wire and keeps what came of it."""

    def __init__(self, inner: Wire, clock: Clock, keep: Callable[[Exchange], None]) -> None:
        self._inner = inner
        self._clock = clock
        self._keep = keep
        self._begun_at = clock.now()

    @property
    def connected(self) -> bool:
        """Return whether a request can be sent."""
        return self._inner.connected

    @property
    def advice(self) -> str:
        """Return what to check when there is no connection."""
        return self._inner.advice

    def epoch(self, unit: int) -> int:
        """Return the wire's own number."""
        return self._inner.epoch(unit)

    async def connect(self) -> bool:
        """Connect, and return whether that worked."""
        return await self._inner.connect()

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        """Return the reply, or raise as the wire does, after keeping it."""
        at_s = (self._clock.now() - self._begun_at).total_seconds()
        try:
            found = await self._inner.exchange(ask, timing, urgent=urgent)
        except Refused as refused:
            self._keep(Exchange(at_s, ask, refused=refused.code))
            raise
        except Unanswered:
            self._keep(Exchange(at_s, ask, silent=True))
            raise
        except Broken as broken:
            self._keep(Exchange(at_s, ask, broken=str(broken)))
            raise
        self._keep(Exchange(at_s, ask, tuple(found)))
        return found

    def hurry(self) -> None:
        """End the wait for a reply that does not come."""
        self._inner.hurry()

    def close(self) -> None:
        """Let go of the connection."""
        self._inner.close()


class Replay:
    """Answers requests as a trace says: each time it is asked the next answer, after the last that one again.

    What the trace never asked is refused as a register that does not exist.
    """

    def __init__(self, exchanges: Sequence[Exchange]) -> None:
        self._left: dict[Ask, list[Exchange]] = {}
        for one in exchanges:
            self._left.setdefault(one.ask, []).append(one)
        self._ended: set[Ask] = set()
        self.remaining = len(exchanges)

    @property
    def units(self) -> tuple[int, ...]:
        """Return the unit ids that were asked."""
        return tuple(sorted({ask.unit for ask in self._left}))

    def next(self, ask: Ask) -> Exchange:
        """Return what comes of a request."""
        waiting = self._left.get(ask)
        if waiting is None:
            return Exchange(0.0, ask, refused=ILLEGAL_ADDRESS)
        if len(waiting) == 1:
            self._drop_once(waiting[0])
            return waiting[0]
        self.remaining -= 1
        return waiting.pop(0)

    def _drop_once(self, last: Exchange) -> None:
        """Count the last answer to a request once, however often it is given."""
        if last.ask not in self._ended:
            self._ended.add(last.ask)
            self.remaining -= 1


class ReplayWire:
    """A wire on which a trace answers; `moved_to` is told when each answer was given."""

    connected = True
    advice = N_("The trace was recorded on another connection.")

    def __init__(self, replay: Replay, moved_to: Callable[[float], None]) -> None:
        self._replay = replay
        self._moved_to = moved_to

    def epoch(self, unit: int) -> int:
        """Return that nothing was ever lost."""
        return 0

    async def connect(self) -> bool:
        """Return that there is a connection."""
        return True

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        """Return the recorded reply, or raise what was recorded instead."""
        found = self._replay.next(ask)
        self._moved_to(found.at_s)
        return found.words()

    def hurry(self) -> None:
        """Do nothing: a trace does not wait."""

    def close(self) -> None:
        """Do nothing: nothing is held."""


class ReplayDevice:
    """One unit of a trace as a device for a Modbus server."""

    def __init__(self, replay: Replay, unit: int) -> None:
        self._replay = replay
        self._unit = unit
        self._silent = False

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        """Return what was recorded for this read."""
        return self._answer(Ask(self._unit, address, count))

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        """Take what was written when the trace was recorded, and nothing else."""
        self._answer(Ask(self._unit, address, len(words), tuple(words)))

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        """Refuse: a trace holds registers."""
        raise Refusal(ILLEGAL_ADDRESS)

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        """Refuse: a trace holds registers."""
        raise Refusal(ILLEGAL_ADDRESS)

    async def let_out(self, reply: bytes) -> bytes | None:
        """Return the reply, None where the device was silent or its reply was no good."""
        silent, self._silent = self._silent, False
        return None if silent else reply

    def _answer(self, ask: Ask) -> list[int]:
        try:
            return self._replay.next(ask).words()
        except Refused as refused:
            raise Refusal(refused.code) from refused
        except (Unanswered, Broken):
            self._silent = True
            return [0] * ask.count
