"""The form of a drive's settings: what is stored as texts, and what was typed as settings."""

from typing import TypeVar

from pydantic import BaseModel

from app.base.message import N_, plain, say, word
from app.tracker.memory.drive_check import DriveChoices
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind, Parity, SerialConfig
from app.tracker.values.typed_numbers import written
from app.web.features.commissioning.drive_contexts import Options
from app.web.shell.forms import Typed, Unreadable

Word = TypeVar("Word", DriveKind, Parity)
KINDS: Options = (
    (DriveKind.SIMULATED.value, N_("Simulated, built in")),
    (DriveKind.MODBUS_TCP.value, N_("Modbus TCP, by network")),
    (DriveKind.MODBUS_RTU.value, N_("Modbus RTU, on a serial port")),
    (DriveKind.MODBUS_RTU_OVER_TCP.value, N_("Modbus RTU through a gateway")),
)
MOST_STEPS, MOST_GEAR = 999_999_999, 999_999
UNITS = (0, 255)
SERIAL_UNITS = (1, 247)
"""On a serial line unit 0 is the broadcast, which nobody answers."""


class DriveForm(BaseModel):
    """The form as it was typed; all texts."""

    kind: str = ""
    profile: str = ""
    host: str = ""
    port: str = ""
    unit: str = ""
    serial_port: str = ""
    serial_other: str = ""
    baud_rate: str = ""
    parity: str = ""
    stop_bits: str = ""
    azimuth_unit: str = ""
    azimuth_steps: str = ""
    azimuth_gear: str = ""
    azimuth_inverted: str = ""
    elevation_unit: str = ""
    elevation_steps: str = ""
    elevation_gear: str = ""
    elevation_inverted: str = ""


def texts_of(drive: DriveConfig) -> dict[str, str]:
    """Return stored settings as the texts of the form."""
    texts = {
        "kind": drive.kind.value,
        "profile": drive.profile,
        "host": drive.host,
        "port": str(drive.port),
        "unit": str(drive.unit),
        "serial_port": drive.serial.port,
        "serial_other": "",
        "baud_rate": str(drive.serial.baud_rate),
        "parity": drive.serial.parity.value,
        "stop_bits": str(drive.serial.stop_bits),
    }
    for axis in Axis:
        texts |= _axis_texts(axis, drive.axis(axis))
    return texts


def _axis_texts(axis: Axis, own: AxisDrive) -> dict[str, str]:
    return {
        f"{axis}_unit": "" if own.unit is None else str(own.unit),
        f"{axis}_steps": ""
        if own.steps_per_revolution is None
        else written(own.steps_per_revolution, MOST_STEPS, None),
        f"{axis}_gear": written(own.gear_ratio, MOST_GEAR, None),
        f"{axis}_inverted": "yes" if own.inverted else "",
    }


def read_drive(typed: Typed, stored: DriveConfig, choices: DriveChoices) -> DriveConfig | None:
    """Return the typed settings, None while anything in them is wrong; what does not count stays stored."""
    kind = typed.read("kind", lambda text: _word(text, DriveKind, N_("Connection")), stored.kind)
    profile = typed.read("profile", lambda text: _profile(text, stored, choices), stored.profile)
    by_network = kind in (DriveKind.MODBUS_TCP, DriveKind.MODBUS_RTU_OVER_TCP)
    units = SERIAL_UNITS if kind in (DriveKind.MODBUS_RTU, DriveKind.MODBUS_RTU_OVER_TCP) else UNITS
    drive = DriveConfig(
        kind,
        profile,
        typed.read("host", _host, stored.host) if by_network else stored.host,
        typed.whole("port", N_("Port"), 1, 65535) if by_network else stored.port,
        stored.unit if kind is DriveKind.SIMULATED else typed.whole("unit", N_("Unit"), *units),
        _serial(typed) if kind is DriveKind.MODBUS_RTU else stored.serial,
        _axis(typed, Axis.AZIMUTH, units),
        _axis(typed, Axis.ELEVATION, units),
    )
    return None if typed.errors else drive


def profile_options(choices: DriveChoices, chosen: str) -> Options:
    """Return the profiles by title, each with what is known of it; the chosen one is always there."""
    known = tuple(
        (
            one.name,
            (
                say("{title} (verified)", title=plain(one.title))
                if one.verified
                else say("{title} (unverified)", title=plain(one.title))
            ),
        )
        for one in choices.profiles
    )
    return known if chosen in dict(known) else (*known, (chosen, chosen))


def port_options(choices: DriveChoices, chosen: str) -> Options:
    """Return the serial ports of the machine by name; the chosen one is always there."""
    known = tuple((one.port, f"{one.port} · {one.description}") for one in choices.ports)
    if chosen and chosen not in dict(known):
        known = (*known, (chosen, say("{chosen} · not plugged in", chosen=chosen)))
    return (("", N_("Choose a port") if known else N_("No serial port was found")), *known)


def _word(text: str, words: type[Word], label: str) -> Word:
    if text not in list(words):
        raise Unreadable(say("{label}: choose one from the list.", label=word(label)))
    return words(text)


def _profile(text: str, stored: DriveConfig, choices: DriveChoices) -> str:
    if text != stored.profile and text not in {one.name for one in choices.profiles}:
        raise Unreadable(N_("Profile: choose one from the list."))
    return text


def _host(text: str) -> str:
    if not text or len(text) > 253:
        raise Unreadable(N_("Host: give the address of the drive or gateway, such as 192.168.1.20."))
    return text


def _serial(typed: Typed) -> SerialConfig:
    other = typed.texts.get("serial_other", "").strip()
    port = other or typed.read("serial_port", _port, "")
    rate = typed.whole("baud_rate", N_("Baud rate"), 300, 4_000_000)
    parity = typed.read("parity", lambda text: _word(text, Parity, N_("Parity")), Parity.EVEN)
    stop_bits = typed.whole("stop_bits", N_("Stop bits"), 1, 2)
    return SerialConfig(port, rate, parity, stop_bits)


def _port(text: str) -> str:
    if not text:
        raise Unreadable(N_("Serial port: choose one, or type the device's path below."))
    return text


def _axis(typed: Typed, axis: Axis, units: tuple[int, int]) -> AxisDrive:
    label = axis.value.capitalize()
    unit, steps = typed.texts.get(f"{axis}_unit", "").strip(), typed.texts.get(f"{axis}_steps", "").strip()
    numbers = (
        typed.whole(f"{axis}_unit", say("{label} unit", label=word(label)), *units) if unit else None,
        typed.number(
            f"{axis}_steps", say("{label} steps per revolution", label=word(label)), 1e-3, MOST_STEPS
        )
        if steps
        else None,
        typed.number(f"{axis}_gear", say("{label} gear ratio", label=word(label)), 1e-4, MOST_GEAR),
    )
    if any(name.startswith(f"{axis}_") for name in typed.errors):
        return AxisDrive()
    return AxisDrive(*numbers, inverted=bool(typed.texts.get(f"{axis}_inverted")))
