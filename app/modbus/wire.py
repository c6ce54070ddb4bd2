"""What the owner of a bus asks of the way to its devices: one request out, one checked reply back."""

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from app.base.message import say
from app.modbus.reply import READ_HOLDING, WRITE_MANY, WRITE_ONE, Wanted, wanted_read, wanted_write


class Broken(Exception):
    """The connection broke or brought a bad reply; the text says what was wrong."""


class Unanswered(Exception):
    """Nothing came in time."""


class GivenUp(Unanswered):
    """The wait for a reply was ended because a stop is more urgent."""


class Refused(Exception):
    """The device answered with an exception."""

    def __init__(self, code: int) -> None:
        super().__init__(say("Modbus exception {code}", code=code))
        self.code = code


@dataclass(frozen=True, slots=True)
class Timing:
    """What a device needs: how long a reply is waited for, how long the line rests after one.

    `longest_reply_s` is the longest that a reply can take; after a missed one nothing is sent before. None
    takes one and a half times the time-out. `registers` is how many of them a poll reads.
    """

    timeout_s: float = 0.3
    rest_s: float = 0.0
    longest_reply_s: float | None = None
    registers: int = 0

    @property
    def silence_s(self) -> float:
        """Return how long after a request its reply may still come."""
        return 1.5 * self.timeout_s if self.longest_reply_s is None else self.longest_reply_s


@dataclass(frozen=True)
class Ask:
    """One request: a read of holding registers, or a write if there are words."""

    unit: int
    address: int
    count: int
    words: tuple[int, ...] = ()

    @property
    def function(self) -> int:
        """Return the function code."""
        if not self.words:
            return READ_HOLDING
        return WRITE_ONE if self.count == 1 else WRITE_MANY

    @cached_property
    def wanted(self) -> Wanted:
        """Return what the reply must look like."""
        if not self.words:
            return wanted_read(self.unit, self.count)
        return wanted_write(self.unit, self.address, self.words)


class Wire(Protocol):
    """The way to the devices of one bus. It cleans up after its own failures."""

    @property
    def connected(self) -> bool:
        """Return whether a request can be sent."""

    @property
    def advice(self) -> str:
        """Return what to check when there is no connection."""

    def epoch(self, unit: int) -> int:
        """Return a number that grows whenever it is no longer certain what a device has taken."""

    async def connect(self) -> bool:
        """Connect, and return whether that worked."""

    async def exchange(self, ask: Ask, timing: Timing, *, urgent: bool) -> list[int]:
        """Return the registers of the reply; raise `Broken`, `Unanswered` or `Refused`."""

    def hurry(self) -> None:
        """End the wait for a reply that does not come, as soon as that does no harm: a stop waits."""

    def close(self) -> None:
        """Let go of the connection."""
