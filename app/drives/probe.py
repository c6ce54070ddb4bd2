"""Reads every register of a device with a profile, decodes it, and changes nothing."""

from collections.abc import AsyncIterator, Sequence

from app.drives.adapters import axis_units
from app.drives.bus import BusUnit
from app.drives.buses import Buses
from app.drives.drive import DriveError, DriveRefused, DriveSilent
from app.drives.line import list_ports
from app.drives.profile import Adapter, Profile, ProfileError
from app.drives.profile_library import ProfileLibrary
from app.drives.profile_rules import has_words
from app.drives.register import Register
from app.drives.sunspec_models import located
from app.tracker.config import DriveConfig, DriveKind
from app.tracker.drive_check import (
    CheckOutcome,
    DriveChoices,
    DriveReadings,
    PortChoice,
    ProfileChoice,
    RegisterReading,
)

SIMULATED = DriveReadings(
    CheckOutcome.ANSWERED, "The simulated drive runs inside Heliopanel: there is no connection to test."
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
            return DriveReadings(CheckOutcome.UNUSABLE, str(error))
        return await probe(self._buses, drive, profile)

    def choices(self) -> DriveChoices:
        """Return the profiles and serial ports of this machine; may touch the disk."""
        ports = tuple(PortChoice(port, description) for port, description in list_ports())
        return DriveChoices(tuple(map(self._choice, self._profiles.names())), ports)

    def _choice(self, name: str) -> ProfileChoice:
        try:
            profile = self._profiles.load(name)
        except ProfileError as error:
            return ProfileChoice(name, name, False, "", (), "", str(error))
        watchdog = "" if profile.watchdog is None else profile.watchdog.action
        return ProfileChoice(
            name, profile.title, profile.verified, profile.source, profile.unverified, watchdog
        )


async def probe(buses: Buses, drive: DriveConfig, profile: Profile) -> DriveReadings:
    """Return every register of a drive's devices, decoded; whatever goes wrong is the answer, too."""
    try:
        registers = [one async for one in _units(buses, drive, profile)]
    except DriveSilent as error:
        return DriveReadings(CheckOutcome.SILENT, str(error))
    except DriveError as error:
        return DriveReadings(CheckOutcome.WRONG_DEVICE, str(error))
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
            read[key] = await _words(unit, first, count, f"{key} of profile {profile.name}")
        yield _reading(unit.unit, profile, register, read[key])


async def _words(unit: BusUnit, first: int, count: int, what: str) -> Words | str:
    try:
        return first, await unit.read(first, count, what=what)
    except DriveRefused as error:
        return str(error)


def _reading(unit_id: int, profile: Profile, register: Register, words: Words | str) -> RegisterReading:
    shown, trouble = ("", words) if isinstance(words, str) else (_shown(profile, register, words), "")
    if not trouble and register.expect is not None and isinstance(words, tuple):
        found = register.integer(words[1], words[0])
        trouble = "" if found == register.expect else f"{found} instead of {register.expect}."
    return RegisterReading(
        register.name,
        register.address,
        unit_id,
        shown,
        register.unit,
        register.text,
        register.verified,
        register.source,
        trouble,
    )


def _shown(profile: Profile, register: Register, words: Words) -> str:
    """Return a value in words: bits and enumerations by their names."""
    first, read = words
    bits = profile.bits.get(register.name)
    if bits is not None:
        value = register.integer(read, first)
        names = [name for name, bit in bits.items() if value >> bit & 1]
        return f"{value} ({', '.join(names) or 'none set'})"
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
        names = "; ".join(f"{one.name} ({one.address}) {_wrong_words(one)}" for one in wrong)
        message = f"The device answers, but is not a {profile.title}: {names}. Check the unit id and profile."
        return DriveReadings(CheckOutcome.WRONG_DEVICE, message, tuple(registers), watchdog_s, action)
    missing = [one.name for one in registers if one.trouble and not profile.registers[one.name].optional]
    if missing:
        message = (
            f"The device answers, but lacks registers that a drive of profile {profile.name} must "
            f"have: {len(missing)} of {len(registers)} registers could not be read ({_listed(missing)}). "
            "Check the unit id and profile."
        )
        return DriveReadings(CheckOutcome.WRONG_DEVICE, message, tuple(registers), watchdog_s, action)
    refused = sum(1 for one in registers if one.trouble)
    more = f" It refuses {refused} that it can do without." if refused else ""
    message = f"The device answers: {len(registers) - refused} registers were read.{more}"
    return DriveReadings(CheckOutcome.ANSWERED, message, tuple(registers), watchdog_s, action)


def _wrong_words(reading: RegisterReading) -> str:
    return f"is {reading.trouble.removesuffix('.')}" if reading.shown else "could not be read"


def _listed(names: list[str]) -> str:
    """Return the first few of many names."""
    more = f" and {len(names) - NAMES_TOLD} more" if len(names) > NAMES_TOLD else ""
    return ", ".join(names[:NAMES_TOLD]) + more


def _watchdog_s(profile: Profile, registers: list[RegisterReading]) -> float | None:
    """Return the watchdog's time-out as the device tells it, None where it does not."""
    readback = profile.watchdog.readback if profile.watchdog is not None else None
    found = next((one.shown for one in registers if one.name == readback and not one.trouble), None)
    return float(found) / 1000.0 if found else None
