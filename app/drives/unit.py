"""One device on a bus as the registers of its profile: only what changed is written."""

from collections.abc import Mapping, Sequence
from typing import Protocol

from app.base.message import Message, say
from app.drives.profile import Block, Profile
from app.drives.register import runs
from app.modbus.bus import Priority
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.line_turn import LineTurn


class Link(Protocol):
    """The way to one unit of a bus; `ticket` changes with every new connection and every stop."""

    @property
    def ticket(self) -> int:
        """Return the number under which a write may still be sent."""

    @property
    def line_turn(self) -> LineTurn:
        """Return how its line is shared."""

    async def read(
        self, address: int, count: int, *, what: str, priority: Priority = Priority.POLL
    ) -> list[int]:
        """Return holding registers, or raise `DriveError`."""

    async def write(
        self,
        address: int,
        words: Sequence[int],
        *,
        what: str,
        ticket: int | None,
        priority: Priority = Priority.COMMAND,
    ) -> None:
        """Write holding registers in one frame, once, or raise `DriveError`."""

    async def stop(self, address: int, words: Sequence[int], *, what: str) -> None:
        """Write ahead of everything that waits."""

    async def close(self) -> None:
        """Let go of the connection."""


class Unit:
    """Reads registers by name and writes those whose words are not what the device already has."""

    def __init__(self, profile: Profile, link: Link, where: str) -> None:
        self.profile = profile
        self.where = where
        self.priority = Priority.COMMAND
        self._link = link
        self._taken: dict[int, int] = {}
        self._to_confirm: dict[str, float] = {}
        self._refused: dict[str, int] = {}
        self._ticket: int | None = None

    @property
    def is_fresh(self) -> bool:
        """Return whether it was read since the connection was made and since the last stop."""
        return self._ticket == self._link.ticket

    @property
    def line_turn(self) -> LineTurn:
        """Return how its line is shared."""
        return self._link.line_turn

    @property
    def was_read(self) -> bool:
        """Return whether it has ever answered."""
        return self._ticket is not None

    def has(self, name: str) -> bool:
        """Return whether the profile has a register and the device did not refuse it when last asked."""
        return name in self.profile.registers and name not in self._refused

    async def poll(self, *names: str) -> dict[str, float]:
        """Return the values of those registers that there are, neighbours of a block in one frame.

        What was refused is asked for again under the next ticket: the refusal may have been of the moment.
        """
        values: dict[str, float] = {}
        for block, members in self._frames(names):
            try:
                words = await self._link.read(block.address, block.count, what=self._what(block.name))
            except DriveRefused:
                if not all(self.profile.registers[name].optional for name in members):
                    raise
                self._refused |= dict.fromkeys(members, self._link.ticket)
                continue
            for name in members:
                self._refused.pop(name, None)
                values[name] = self.profile.registers[name].value(words, block.address)
        return values

    async def look(self, *names: str) -> dict[str, float]:
        """Return values as `poll` does; what is decided in their light may be written.

        A poll in the midst of a command does not renew that leave: a stop may have come since it was given.
        """
        values = await self.poll(*names)
        self._ticket = self._link.ticket
        return values

    async def confirm(self) -> None:
        """Read back what was written last; raise `DriveError` if the device does not hold it."""
        expected, self._to_confirm = self._to_confirm, {}
        found = await self.poll(*expected) if expected else {}
        for name, value in found.items():
            if value != expected[name]:
                self.forget()
                raise self.not_taken(self.profile.at(self.profile.registers[name].address))

    def not_taken(self, what: str) -> DriveError:
        """Return the error that a command was acknowledged and not carried out."""
        return DriveError(
            say(
                "The drive at {where} acknowledged a command but did not carry it out ({what}). "
                "Check that the drive is in remote operation.",
                where=self.where,
                what=what,
            )
        )

    async def put(
        self, values: Mapping[str, float], *, renewed: bool = False, confirmed: bool = False
    ) -> None:
        """Write values in their units, neighbours in one frame; with `renewed` also what did not change.

        With `confirmed` the next reading checks that the device holds them.
        """
        words = self.words(values)
        changed = {at: word for at, word in words.items() if renewed or self._taken.get(at) != word}
        for address, run in runs(changed, words):
            what = self._what(self.profile.at(address))
            told = dict(enumerate(run, address))
            for place in told:
                self._taken.pop(place, None)
            await self._link.write(address, run, what=what, ticket=self._ticket, priority=self.priority)
            self._taken |= told
        if confirmed and changed:
            self.expect(values)

    def expect(self, values: Mapping[str, float]) -> None:
        """Have the next reading check that the device holds these values."""
        self._to_confirm |= self._rounded(values)

    async def play(self, sequence: str) -> None:
        """Write what a sequence of the profile says, one frame a step."""
        for step in self.profile.sequences[sequence]:
            register = self.profile.registers[step.register]
            await self.put({step.register: step.value * register.scale * register.sign}, renewed=True)

    async def stop(self, values: Mapping[str, float]) -> None:
        """Write values ahead of everything that waits."""
        self.forget()
        words = self.words(values)
        for address, run in runs(words, words):
            await self._link.stop(
                address, run, what=self._what(say("stop, {address}", address=self.profile.at(address)))
            )

    def forget(self) -> None:
        """Believe no longer that the device holds what was written."""
        self._taken.clear()
        self._to_confirm.clear()

    async def close(self) -> None:
        """Let go of the connection."""
        await self._link.close()

    def words(self, values: Mapping[str, float]) -> dict[int, int]:
        """Return address and word of values in their units, without those that the profile lacks."""
        words: dict[int, int] = {}
        for name, value in values.items():
            if self.has(name):
                words |= self.profile.registers[name].placed(value)
        return words

    def _rounded(self, values: Mapping[str, float]) -> dict[str, float]:
        registers = self.profile.registers
        return {
            name: registers[name].value(registers[name].words(value), registers[name].address)
            for name, value in values.items()
            if self.has(name)
        }

    def _frames(self, names: Sequence[str]) -> list[tuple[Block, list[str]]]:
        """Return what has to be read for some registers: a block of the profile, or the register alone."""
        frames: dict[str, tuple[Block, list[str]]] = {}
        for name in filter(self._is_asked, names):
            register = self.profile.registers[name]
            block = self.profile.block_of(register) or Block(name, register.address, register.count)
            frames.setdefault(block.name, (block, []))[1].append(name)
        return list(frames.values())

    def _is_asked(self, name: str) -> bool:
        return name in self.profile.registers and self._refused.get(name) != self._link.ticket

    def _what(self, name: str) -> Message:
        return say("{name} of profile {name2}", name=name, name2=self.profile.name)
