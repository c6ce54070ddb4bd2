"""Commands and readings as the registers of a PLC with setpoints: the same table for master and server."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple

from app.base.message import N_, say
from app.drives.dialects.extremes import check_encoded, extremes
from app.drives.profile import Profile
from app.drives.register import Register, ValueMisfit
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.values.motion import (
    HALT,
    AxisCommand,
    AxisFeedback,
    DriveCommand,
    DriveRequest,
    Feedback,
    Halt,
    LightPair,
    LightReading,
    Position,
    RequestKind,
    Velocity,
)

NEEDED = (
    "keep_alive", "status", "fault_code", "boot_count", "request_number", "request_kind", "request_done",
    *(f"{axis}_{part}" for axis in Axis for part in ("motion", "setpoint", "speed", "position", "velocity")),
)  # fmt: skip
LIGHT = tuple(f"light_{axis}_{side}" for axis in Axis for side in ("lower", "higher"))
COUNTED, MOST_COUNTED = ("keep_alive", "request_number"), 0xFFFF
CLOCK_PARTS = ("year", "month", "day", "hour", "minute", "second")
NEEDED_ENUMS = {"motion": ("halt", "velocity", "position"), "request": ("none",)}
NO_SWITCHES: Mapping[str, int] = {}


class PlcMap:
    """Where everything of the drive protocol stands in a profile's registers."""

    def __init__(self, profile: Profile) -> None:
        _check(profile)
        self._registers = profile.registers
        self._horn = profile.registers.get("horn")
        self.positions = {axis: profile.registers[f"{axis}_position"] for axis in Axis}
        self._status = profile.bits["status"]
        self._switches = profile.bits.get("switches", NO_SWITCHES)
        self._motions = profile.enums["motion"]
        self._requests = profile.enums["request"]
        self._kinds = {number: kind for kind, number in self._requests.items()}

    def command_words(self, command: DriveCommand) -> dict[int, int]:
        """Return address and word of everything a command says; nothing about a request or horn it lacks."""
        words: dict[int, int] = {}
        for axis, wanted in ((Axis.AZIMUTH, command.azimuth), (Axis.ELEVATION, command.elevation)):
            for name, value in self.axis_values(axis, wanted).items():
                words |= self.words(name, value)
        if command.horn:
            words |= self.words("horn", 1)
        if command.request is not None:
            words |= self.words("request_number", command.request.number & 0xFFFF)
            words |= self.words("request_kind", self._requests[command.request.kind])
        return words

    def axis_values(self, axis: Axis, wanted: AxisCommand) -> dict[str, float]:
        """Return what one axis is told, by the names of its registers."""
        motion, setpoint, speed = self._numbers(wanted)
        return {f"{axis}_motion": motion, f"{axis}_setpoint": setpoint, f"{axis}_speed": speed}

    def check_fit(self, axis: Axis, config: AxisConfig) -> None:
        """Raise `ValueMisfit` if an axis's settings command a number that does not fit into its register."""
        for command in extremes(config):
            values = self.axis_values(axis, command)
            check_encoded(axis, self._registers, values)

    def words(self, name: str, value: float) -> dict[int, int]:
        """Return address and word of one register's value; nothing if the profile has no such register."""
        register = self._registers.get(name)
        if register is None:
            return {}
        return register.placed(value)

    def command(self, words: Sequence[int], first_address: int) -> DriveCommand:
        """Return the command that registers hold, or raise `ValueError` for a number without meaning."""
        request = None
        kind = self._kinds.get(self._integer("request_kind", words, first_address))
        if kind is None:
            raise ValueError(N_("This request type does not exist."))
        if kind != "none":
            number = self._integer("request_number", words, first_address)
            request = DriveRequest(number, RequestKind(kind))
        return DriveCommand(
            azimuth=self._axis_command(Axis.AZIMUTH, words, first_address),
            elevation=self._axis_command(Axis.ELEVATION, words, first_address),
            request=request,
            horn=bool(self._horn is not None and self._integer("horn", words, first_address)),
        )

    def feedback_words(self, feedback: Feedback) -> dict[int, int]:
        """Return address and word of everything a reading says."""
        return {
            **self.words("status", _packed(self._status, _status_flags(feedback))),
            **self.words("switches", _packed(self._switches, _switch_flags(feedback))),
            **self.words("fault_code", feedback.fault_code & 0xFFFF),
            **self.words("boot_count", feedback.boot_count & 0xFFFF),
            **self.words("request_done", feedback.request_done & 0xFFFF),
            **self.words("azimuth_position", feedback.azimuth.position_deg),
            **self.words("elevation_position", feedback.elevation.position_deg),
            **self.words("azimuth_velocity", feedback.azimuth.velocity_dps),
            **self.words("elevation_velocity", feedback.elevation.velocity_dps),
            **self.words("supply", feedback.supply_v or 0.0),
            **self._light_words(feedback.light),
        }

    def feedback(self, words: Sequence[int], first_address: int) -> Feedback:
        """Return the reading that registers hold."""
        status = self._integer("status", words, first_address)
        switches = self._integer("switches", words, first_address) if self._switches else 0
        return Feedback(
            azimuth=self._axis_feedback("azimuth", words, first_address, status, switches),
            elevation=self._axis_feedback("elevation", words, first_address, status, switches),
            boot_count=self._integer("boot_count", words, first_address),
            fault_code=self._integer("fault_code", words, first_address),
            homing=_flag(self._status, "homing", status),
            watchdog_tripped=_flag(self._status, "watchdog_tripped", status),
            request_done=self._integer("request_done", words, first_address),
            request_failed=_flag(self._status, "request_failed", status),
            light=self._light(words, first_address),
            local=_flag(self._status, "local", status),
            supply_v=self._supply_v(words, first_address),
        )

    def _supply_v(self, words: Sequence[int], first_address: int) -> float | None:
        """Return the supply voltage; None without a register for it, or if that reads nothing."""
        register = self._registers.get("supply")
        return None if register is None else register.value(words, first_address) or None

    def _light(self, words: Sequence[int], first_address: int) -> LightReading | None:
        """Return what the photo-sensors read; None without registers for all four, or if all read nothing."""
        if not all(name in self._registers for name in LIGHT):
            return None
        read = [self._registers[name].value(words, first_address) for name in LIGHT]
        if not any(read):
            return None
        return LightReading(LightPair(read[0], read[1]), LightPair(read[2], read[3]))

    def _light_words(self, light: LightReading | None) -> dict[int, int]:
        if light is None:
            return {}
        values = (*astuple(light.azimuth), *astuple(light.elevation))
        return {
            address: word
            for name, value in zip(LIGHT, values, strict=True)
            for address, word in self.words(name, value).items()
        }

    def _axis_feedback(
        self, axis: str, words: Sequence[int], first_address: int, status: int, switches: int
    ) -> AxisFeedback:
        return AxisFeedback(
            position_deg=self._registers[f"{axis}_position"].value(words, first_address),
            velocity_dps=self._registers[f"{axis}_velocity"].value(words, first_address),
            moving=_flag(self._status, f"{axis}_moving", status),
            homed=_flag(self._status, f"{axis}_homed", status),
            at_lower_limit=_flag(self._switches, f"{axis}_lower_limit", switches),
            at_upper_limit=_flag(self._switches, f"{axis}_upper_limit", switches),
            at_origin=_flag(self._switches, f"{axis}_origin", switches),
        )

    def _axis_command(self, axis: Axis, words: Sequence[int], first_address: int) -> AxisCommand:
        motion = self._integer(f"{axis}_motion", words, first_address)
        setpoint = self._registers[f"{axis}_setpoint"].value(words, first_address)
        if motion == self._motions["velocity"]:
            return Velocity(setpoint)
        if motion == self._motions["position"]:
            return Position(setpoint, self._registers[f"{axis}_speed"].value(words, first_address))
        if motion == self._motions["halt"]:
            return HALT
        raise ValueError(say("Motion number {motion} does not exist.", motion=motion))

    def _numbers(self, wanted: AxisCommand) -> tuple[int, float, float]:
        match wanted:
            case Velocity(velocity_dps):
                return self._motions["velocity"], velocity_dps, 0.0
            case Position(position_deg, speed_dps):
                return self._motions["position"], position_deg, speed_dps
            case Halt():
                return self._motions["halt"], 0.0, 0.0

    def _integer(self, name: str, words: Sequence[int], first_address: int) -> int:
        return self._registers[name].integer(words, first_address)


def _status_flags(feedback: Feedback) -> dict[str, bool]:
    return {
        "azimuth_moving": feedback.azimuth.moving,
        "elevation_moving": feedback.elevation.moving,
        "azimuth_homed": feedback.azimuth.homed,
        "elevation_homed": feedback.elevation.homed,
        "homing": feedback.homing,
        "watchdog_tripped": feedback.watchdog_tripped,
        "request_failed": feedback.request_failed,
        "local": feedback.local,
    }


def _switch_flags(feedback: Feedback) -> dict[str, bool]:
    return {
        "azimuth_lower_limit": feedback.azimuth.at_lower_limit,
        "azimuth_upper_limit": feedback.azimuth.at_upper_limit,
        "azimuth_origin": feedback.azimuth.at_origin,
        "elevation_lower_limit": feedback.elevation.at_lower_limit,
        "elevation_upper_limit": feedback.elevation.at_upper_limit,
        "elevation_origin": feedback.elevation.at_origin,
    }


def _packed(bits: Mapping[str, int], flags: Mapping[str, bool]) -> int:
    return sum(1 << bit for name, bit in bits.items() if flags.get(name, False))


def _flag(bits: Mapping[str, int], name: str, word: int) -> bool:
    bit = bits.get(name)
    return bit is not None and bool(word >> bit & 1)


def _check(profile: Profile) -> None:
    """Raise `ProfileError` unless the profile names everything the adapter needs."""
    for name in NEEDED:
        if name not in profile.registers:
            raise profile.text.error(f"registers.{name}", f"a plc needs a register named {name}")
    _check_counted(profile)
    if "status" not in profile.blocks:
        raise profile.text.error("blocks.status", "a plc needs a block named status")
    if "status" not in profile.bits:
        raise profile.text.error("bits.status", "a plc needs the bits of its status register")
    for enum, words in NEEDED_ENUMS.items():
        for word in words:
            if word not in profile.enums.get(enum, {}):
                raise profile.text.error(f"enums.{enum}", f"the enumeration {enum} needs the word {word}")
    _check_block(profile)


def _check_counted(profile: Profile) -> None:
    """Raise `ProfileError` for a counter that could not hold its numbers one day."""
    for name in COUNTED:
        try:
            profile.registers[name].packed(MOST_COUNTED)
        except ValueMisfit as misfit:
            rule = f"{name} counts to {MOST_COUNTED}: make it uint16"
            raise profile.text.error(f"registers.{name}.type", rule) from misfit


def _check_block(profile: Profile) -> None:
    inside = profile.blocks["status"].addresses
    readback = profile.watchdog.readback if profile.watchdog is not None else None
    signs = ("heartbeat", "echo", *filter(None, (readback,)))
    others = (*LIGHT, *signs, "supply", *(name for name in profile.bits if name == "switches"))
    for name in (*NEEDED, *(other for other in others if other in profile.registers)):
        register: Register = profile.registers[name]
        if not all(address in inside for address in register.addresses):
            raise profile.text.error(f"registers.{name}.address", f"{name} lies outside the status block")
