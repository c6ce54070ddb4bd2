"""A PLC that offers setpoints, reached over Modbus, as a drive: the profile says where everything is."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from datetime import UTC, datetime

from app.base.clock import Clock
from app.base.message import N_, say
from app.drives.dialects.plc_map import CLOCK_PARTS, PlcMap
from app.drives.dialects.plc_signs import SignsOfLife
from app.drives.plausibility import Plausibility
from app.drives.profile import Profile
from app.drives.register import runs
from app.modbus.bus import BusUnit, Priority
from app.modbus.errors import DriveError, DriveRefused
from app.modbus.line_turn import LineTurn
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.motion import HALT, DriveCapabilities, DriveCommand, Feedback, Velocity

STAND = DriveCommand(Velocity(0.0), Velocity(0.0))
"""What stops a PLC that has no stop register; unlike `Halt` it also ends a search for the origin."""


class PlcDrive:
    """The drive protocol on a profile's registers.

    Every poll is one frame that holds identity, heartbeat, status and what the PLC took of the last command.
    Only what changed is written, in one frame with the keep-alive value that feeds the PLC's watchdog.
    """

    def __init__(self, config: TrackerConfig, profile: Profile, clock: Clock, link: BusUnit) -> None:
        self._config = config
        self._profile = profile
        self._map = PlcMap(profile)
        self._link = link
        self._plausibility = Plausibility(config, clock, self._map.positions)
        self._block = profile.blocks["status"]
        self._taken: dict[int, int] = {}
        self._seen: list[int] = []
        self._keep_alive = 0
        self._urgency = Priority.POLL
        self._ticket: int | None = None
        self._stops = 0
        self._request_number = 0
        self._sounds = False
        self._boot_count: int | None = None
        self._signs = SignsOfLife(profile, lambda: str(link))

    @property
    def profile_name(self) -> str:
        """Return the name of its profile."""
        return self._profile.name

    @property
    def link(self) -> BusUnit:
        """Return the way to the PLC."""
        return self._link

    @property
    def line_turn(self) -> LineTurn:
        """Return how its line is shared."""
        return self._link.line_turn

    @property
    def capabilities(self) -> DriveCapabilities:
        """Return what the profile offers; the watchdog's time-out is the device's own once it was read."""
        return DriveCapabilities(
            automatic_homing="home" in self._profile.enums["request"],
            watchdog_s=self._signs.watchdog_s,
            settable_clock="clock" in self._profile.blocks,
            limit_switches="switches" in self._profile.bits,
            description=f"{self._profile.title}, {self._link}",
            verified=self._profile.verified,
            watchdog_action=self._profile.watchdog.action if self._profile.watchdog is not None else "",
            unverified=self._profile.unverified,
        )

    def check_fit(self) -> None:
        """Raise `ValueMisfit` if the settings command a number that does not fit into its register."""
        for axis in self._config.mount.axes:
            self._map.check_fit(axis, self._config.axis(axis))

    async def read(self) -> Feedback:
        """Return one fresh, checked and complete reading, or raise `DriveError`."""
        words = await self._poll()
        feedback = self._map.feedback(words, self._block.address)
        if self._plausibility.doubt(feedback) is not None:
            words = await self._poll()
            feedback = self._plausibility.settle(feedback, self._map.feedback(words, self._block.address))
        self._signs.watch_watchdog(words, self._block.address, feedback)
        self._plausibility.accept(feedback)
        self._notice_restart(feedback)
        self._compare(words, feedback)
        return self._numbered(feedback)

    async def write(self, command: DriveCommand) -> None:
        """Send what changed and a new keep-alive value, or raise `DriveError`; nothing is sent twice."""
        if self._ticket != self._link.ticket:
            await self._look_again()
        ticket = self._ticket
        self._keep_alive = self._keep_alive % 0xFFFF + 1
        words = self._map.command_words(command) | self._map.words("keep_alive", self._keep_alive)
        if self._sounds and not command.horn:
            words |= self._map.words("horn", 0)
        if command.request is not None:
            self._request_number = command.request.number
        self._urgency = Priority.JOG if _turns(command) else Priority.POLL
        taken = self._taken
        self._taken = {}
        for address, values in self._frames(words, taken):
            await self._link.write(
                address,
                values,
                what=say("the command registers from {address}", address=self._profile.at(address)),
                ticket=ticket,
                priority=_priority(command),
            )
        self._sounds = command.horn
        self._signs.fed()
        if ticket == self._link.ticket:
            self._taken = taken | words

    async def stop(self) -> None:
        """Ramp both axes down, ahead of everything that waits, or raise `DriveError`."""
        self._forget()
        self._stops += 1
        stop = self._map.words("stop", 1) or self._map.command_words(STAND)
        for address, values in runs(stop, stop):
            await self._link.stop(
                address, values, what=say("stop, {address}", address=self._profile.at(address))
            )

    async def set_clock(self, at: datetime) -> None:
        """Set the PLC's clock to an instant, in UTC, if the profile has one."""
        block = self._profile.blocks.get("clock")
        if block is None:
            return
        utc = at.astimezone(UTC)
        words = {
            address: word
            for part in CLOCK_PARTS
            for address, word in self._map.words(part, getattr(utc, part)).items()
        }
        for address, values in runs(words, words):
            await self._link.write(address, values, what=N_("the clock"), ticket=None)

    async def close(self) -> None:
        """Stop the axes if the PLC can be reached, then let go of the connection."""
        try:
            if self._ticket is not None:
                with suppress(DriveError):
                    await self.stop()
        finally:
            await self._link.close()

    async def _look_again(self) -> None:
        """Read the state anew; raise `DriveError` if it is not the one that the command was meant for."""
        stops, boot_count = self._stops, self._boot_count
        await self.read()
        if self._stops != stops:
            raise DriveError(N_("A stop had priority over this command; the command was not written."))
        if boot_count not in (None, self._boot_count):
            raise DriveError(
                say("The drive at {link} has restarted: an earlier command was not written.", link=self._link)
            )

    async def _poll(self) -> list[int]:
        block = self._block
        what = say("block {name} of profile {name2}", name=block.name, name2=self._profile.name)
        words = await self._link.read(block.address, block.count, what=what, priority=self._urgency)
        self._ticket = self._link.ticket
        self._identify(words)
        self._signs.watch(words, block.address)
        return words

    def _integer(self, name: str, words: list[int]) -> int:
        return self._profile.registers[name].integer(words, self._block.address)

    def _identify(self, words: list[int]) -> None:
        for register in self._profile.registers.values():
            if register.expect is None:
                continue
            found = self._integer(register.name, words)
            if found != register.expect:
                raise DriveRefused(
                    say(
                        "The device at {link} is not a {title}: register {address} holds {found} instead of "
                        "{expect}. Check the address, unit id, and profile.",
                        link=self._link,
                        title=self._profile.title,
                        address=self._profile.at(register.address),
                        found=found,
                        expect=register.expect,
                    )
                )

    def _notice_restart(self, feedback: Feedback) -> None:
        if self._boot_count is not None and feedback.boot_count != self._boot_count:
            self._forget()
        self._boot_count = feedback.boot_count

    def _compare(self, words: list[int], feedback: Feedback) -> None:
        """Raise `DriveError` if the PLC does not hold what was written; then everything is written anew."""
        taken, before, self._seen = self._taken, self._seen, words
        if feedback.watchdog_tripped:
            self._forget()
            return
        first = self._block.address
        wrong = [
            address - first
            for address, word in taken.items()
            if 0 <= address - first < self._block.count and words[address - first] != word
        ]
        if not wrong:
            return
        self._forget()
        where = self._profile.at(first + wrong[0])
        if before and all(words[place] == before[place] for place in wrong):
            raise DriveError(
                say(
                    "The drive at {link} acknowledged a command but did not carry it out (register "
                    "{where}). Check that the drive is in remote operation.",
                    link=self._link,
                    where=where,
                )
            )
        raise DriveError(
            say(
                "Another master commands the drive at {link}: register {where} holds a value that "
                "Heliopanel did not write. Disconnect the other Modbus master.",
                link=self._link,
                where=where,
            )
        )

    def _forget(self) -> None:
        self._taken = {}

    def _frames(self, words: Mapping[int, int], taken: Mapping[int, int]) -> list[tuple[int, list[int]]]:
        """Return what has to be written: the frame with the keep-alive value last, so that it stands for all.

        When everything is written anew it goes first, as it is what ends a stop by the watchdog.
        """
        changed = {address: word for address, word in words.items() if taken.get(address) != word}
        keep_alive = self._profile.registers["keep_alive"].address
        frames = runs(changed, words)
        return sorted(
            frames, key=lambda frame: frame[0] <= keep_alive < frame[0] + len(frame[1]), reverse=not taken
        )

    def _numbered(self, feedback: Feedback) -> Feedback:
        """Return the reading with the full number of the request that the 16-bit register stands for."""
        if feedback.request_done != self._request_number & 0xFFFF:
            return feedback
        return _with_request(feedback, self._request_number)


def _with_request(feedback: Feedback, number: int) -> Feedback:
    return replace(feedback, request_done=number)


def _turns(command: DriveCommand) -> bool:
    """Return whether an axis is turned by hand; its readings must not wait for other drives' on the line."""
    return any(
        isinstance(axis, Velocity) and axis.velocity_dps for axis in (command.azimuth, command.elevation)
    )


def _priority(command: DriveCommand) -> Priority:
    jogging = isinstance(command.azimuth, Velocity) or isinstance(command.elevation, Velocity)
    halting = command.azimuth == HALT and command.elevation == HALT
    return Priority.JOG if jogging or halting else Priority.COMMAND
