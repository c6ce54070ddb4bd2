"""Reads every register of a device with a profile, decodes it, and changes nothing."""

from collections.abc import AsyncIterator, Sequence

from app.base.message import N_, Message, join, plain, say, told_by
from app.drives.connections.adapters import axis_units
from app.drives.connections.buses import Buses
from app.drives.dialects.sunspec_models import located
from app.drives.profile import Adapter, Profile, ProfileError
from app.drives.profile_library import ProfileLibrary
from app.drives.profile_rules import has_words
from app.drives.register import Register
from app.modbus.bus import BusUnit
from app.modbus.errors import DriveError, DriveRefused, DriveSilent
from app.modbus.line import list_ports
from app.tracker.memory.drive_check import (
    CheckOutcome,
    DriveChoices,
    DriveReadings,
    PortChoice,
    ProfileChoice,
    RegisterReading,
)
from app.tracker.settings.config import DriveConfig, DriveKind

SIMULATED = DriveReadings(
    CheckOutcome.ANSWERED, N_("The simulated drive runs inside Heliopanel: there is no connection to test.")
)
NAMES_TOLD = 4
Words = tuple[int, Sequence[int]]
"""A first address, and the words from there on."""


class DriveProbe:
    """Looks at drives on the buses that the machine already has, beside what they are doing."""

    def __init__(self, buses: Buses, profiles: ProfileLibrary) -> None:
        self._buses = buses
        self._profiles = profiles

    async def look(self, drive: DriveConfig) -> DriveReadings:
        """Return what a drive answers; whatever goes wrong is the answer, too."""
        if drive.kind is DriveKind.SIMULATED:
            return SIMULATED
        try:
            profile = self._profiles.load(drive.profile)
            if profile.adapter.has_unit_per_axis:
                axis_units(drive)
        except ProfileError as error:
            return DriveReadings(CheckOutcome.UNUSABLE, told_by(error))
        return await probe(self._buses, drive, profile)

    def choices(self) -> DriveChoices:
        """Return the profiles and serial ports of this machine; may touch the disk."""
        ports = tuple(PortChoice(port, description) for port, description in list_ports())
        return DriveChoices(tuple(map(self._choice, self._profiles.names())), ports)

    def _choice(self, name: str) -> ProfileChoice:
        try:
            profile = self._profiles.load(name)
        except ProfileError as error:
            return ProfileChoice(name, name, False, "", (), "", told_by(error))
        watchdog = "" if profile.watchdog is None else profile.watchdog.action
        return ProfileChoice(
            name, profile.title, profile.verified, profile.source, profile.unverified, watchdog
        )


async def probe(buses: Buses, drive: DriveConfig, profile: Profile) -> DriveReadings:
    """Return every register of a drive's devices, decoded; whatever goes wrong is the answer, too."""
    try:
        registers = [one async for one in _units(buses, drive, profile)]
    except DriveSilent as error:
        return DriveReadings(CheckOutcome.SILENT, told_by(error))
    except DriveError as error:
        return DriveReadings(CheckOutcome.WRONG_DEVICE, told_by(error))
    return _judged(profile, registers)


async def _units(buses: Buses, drive: DriveConfig, profile: Profile) -> AsyncIterator[RegisterReading]:
    for number in drive.units:
        unit = buses.unit(drive, number, profile.timing)
        try:
            if profile.adapter is Adapter.SUNSPEC:
                profile = await located(profile, unit, str(unit))
            async for reading in read_registers(unit, profile):
                yield reading
        finally:
            await unit.close()


async def read_registers(unit: BusUnit, profile: Profile) -> AsyncIterator[RegisterReading]:
    """Yield every register decoded, or raise `DriveSilent`; what the device refuses says so itself."""
    read: dict[str, Words | str] = {}
    for register in profile.registers.values():
        block = profile.block_of(register)
        key = register.name if block is None else block.name
        if key not in read:
            first, count = (
                (register.address, register.count) if block is None else (block.address, block.count)
            )
            read[key] = await _words(
                unit, first, count, say("{key} of profile {name}", key=key, name=profile.name)
            )
        yield _reading(unit.unit, profile, register, read[key])


async def _words(unit: BusUnit, first: int, count: int, what: str) -> Words | str:
    try:
        return first, await unit.read(first, count, what=what)
    except DriveRefused as error:
        return told_by(error)


def _reading(unit_id: int, profile: Profile, register: Register, words: Words | str) -> RegisterReading:
    shown, trouble = ("", words) if isinstance(words, str) else (_shown(profile, register, words), "")
    if not trouble and register.expect is not None and isinstance(words, tuple):
        found = register.integer(words[1], words[0])
        trouble = (
            ""
            if found == register.expect
            else say("{found} instead of {expect}.", found=found, expect=register.expect)
        )
    return RegisterReading(
        register.name,
        register.address,
        unit_id,
        shown,
        register.unit,
        register.text,
        register.verified,
        register.source,
        plain(trouble),
    )


def _shown(profile: Profile, register: Register, words: Words) -> str:
    """Return a value in words: bits and enumerations by their names."""
    first, read = words
    bits = profile.bits.get(register.name)
    if bits is not None:
        value = register.integer(read, first)
        names = [name for name, bit in bits.items() if value >> bit & 1]
        return say("{value} ({names})", value=value, names=", ".join(names) or N_("none set"))
    for name, numbers in profile.enums.items():
        if has_words(register.name, name):
            value = register.integer(read, first)
            word = next((word for word, number in numbers.items() if number == value), "unknown")
            return f"{value} ({word})"
    return f"{register.value(read, first):g}" if register.scale == 1.0 else f"{register.value(read, first)}"


def _judged(profile: Profile, registers: list[RegisterReading]) -> DriveReadings:
    wrong = [one for one in registers if one.trouble and profile.registers[one.name].expect is not None]
    watchdog = profile.watchdog
    watchdog_s = _watchdog_s(profile, registers)
    action = "" if watchdog is None else watchdog.action
    if wrong:
        names = join(
            "; ",
            (
                say(
                    "{name} ({address}) {wrong}",
                    name=one.name,
                    address=one.address,
                    wrong=_wrong_words(profile, one),
                )
                for one in wrong
            ),
        )
        message = say(
            "The device answers, but is not a {title}: {names}. Check the unit id and profile.",
            title=profile.title,
            names=names,
        )
        return DriveReadings(CheckOutcome.WRONG_DEVICE, message, tuple(registers), watchdog_s, action)
    missing = [one.name for one in registers if one.trouble and not profile.registers[one.name].optional]
    if missing:
        message = say(
            "The device answers, but lacks registers that a drive of profile {name} must have: "
            "{missing} of {registers} registers could not be read ({missing2}). Check the unit "
            "id and profile.",
            name=profile.name,
            missing=len(missing),
            registers=len(registers),
            missing2=_listed(missing),
        )
        return DriveReadings(CheckOutcome.WRONG_DEVICE, message, tuple(registers), watchdog_s, action)
    refused = sum(1 for one in registers if one.trouble)
    message = say("The device answers: {registers} registers were read.", registers=len(registers) - refused)
    if refused:
        more = say("It refuses {refused} that it can do without.", refused=refused)
        message = join(" ", (message, more))
    return DriveReadings(CheckOutcome.ANSWERED, message, tuple(registers), watchdog_s, action)


def _wrong_words(profile: Profile, reading: RegisterReading) -> Message:
    if not reading.shown:
        return N_("could not be read")
    expected = profile.registers[reading.name].expect
    return say("is {found} instead of {expect}", found=reading.shown, expect=expected)


def _listed(names: list[str]) -> Message:
    """Return the first few of many names."""
    more = " " + say("and {count} more", count=len(names) - NAMES_TOLD) if len(names) > NAMES_TOLD else ""
    return join(", ", names[:NAMES_TOLD]) + more


def _watchdog_s(profile: Profile, registers: list[RegisterReading]) -> float | None:
    """Return the watchdog's time-out as the device tells it, None where it does not."""
    readback = profile.watchdog.readback if profile.watchdog is not None else None
    found = next((one.shown for one in registers if one.name == readback and not one.trouble), None)
    return float(found) / 1000.0 if found else None
