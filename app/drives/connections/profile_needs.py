"""What each adapter needs of a profile: registers, bits and words, as a table."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from app.drives.dialects.gearing import RAMPS, SPEEDS
from app.drives.dialects.plc_map import PlcMap
from app.drives.profile import Adapter, Profile, ProfileError


@dataclass(frozen=True, slots=True)
class Needs:
    """Names that a profile must have; `speeds` and `ramps` are registers whose unit must be known."""

    registers: tuple[str, ...]
    bits: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    words: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    sequences: tuple[str, ...] = ()
    speeds: tuple[str, ...] = ("velocity",)
    ramps: tuple[str, ...] = ()


NEEDS = {
    Adapter.CIA402: Needs(
        registers=(
            "controlword", "statusword", "mode", "position", "target_position", "profile_velocity",
            "homing_method",
        ),
        bits={"statusword": ("homed",)},
        words={"homing_method": ("home", "set_home")},
        speeds=("velocity", "profile_velocity", "target_velocity"),
        ramps=("profile_acceleration", "profile_deceleration"),
    ),
    Adapter.PR: Needs(
        registers=(
            "status", "position", "trigger", "path_mode", "path_position", "path_speed",
            "path_acceleration", "path_deceleration", "path_pause", "path_trigger",
        ),
        bits={"status": ("fault", "enabled", "running", "homed")},
        words={
            "path_mode": ("absolute", "velocity"),
            "path_trigger": ("start",),
            "trigger": ("home", "set_home", "stop"),
        },
        sequences=("enable", "reset_fault"),
        speeds=("velocity", "path_speed"),
        ramps=("path_acceleration", "path_deceleration"),
    ),
    Adapter.DIRECT: Needs(
        registers=(
            "direct_data_number", "direct_type", "direct_position", "direct_speed",
            "direct_acceleration", "direct_deceleration", "direct_current", "direct_trigger",
            "input_command", "output", "position",
        ),
        bits={"output": ("alarm", "moving", "homed")},
        words={
            "direct_type": ("absolute", "continuous"),
            "direct_current": ("full",),
            "direct_trigger": ("start",),
            "input_command": ("home", "stop", "alarm_reset"),
        },
        sequences=("set_home",),
        speeds=("velocity", "direct_speed"),
        ramps=("direct_acceleration", "direct_deceleration"),
    ),
    Adapter.SUNSPEC: Needs(
        registers=(
            "sunspec_id", "sunspec_id_end", "first_model", "model", "alarms", "scale",
            "azimuth_position", "elevation_position", "azimuth_target", "elevation_target", "control",
            "tracker_alarms",
        ),
        words={"control": ("automatic", "manual", "calibrate")},
        speeds=(),
    ),
}  # fmt: skip


def check_needs(profile: Profile) -> None:
    """Raise `ProfileError` unless the profile names everything that its adapter needs."""
    if profile.adapter is Adapter.PLC:
        PlcMap(profile)
        return
    needs = NEEDS[profile.adapter]
    for name in needs.registers:
        if name not in profile.registers:
            raise _error(profile, f"registers.{name}", f"needs a register named {name}")
    _check_words(profile, needs)
    for name in needs.sequences:
        if name not in profile.sequences:
            raise _error(profile, f"sequences.{name}", f"needs a sequence named {name}")
    _check_units(profile, needs.speeds, SPEEDS)
    _check_units(profile, needs.ramps, RAMPS)


def _check_words(profile: Profile, needs: Needs) -> None:
    for table, wanted, given in (
        ("bits", needs.bits, profile.bits),
        ("enums", needs.words, profile.enums),
    ):
        for name, words in wanted.items():
            for word in words:
                if word not in given.get(name, {}):
                    raise _error(profile, f"{table}.{name}.{word}", f"needs {word} in {table}.{name}")


def _check_units(profile: Profile, names: tuple[str, ...], known: Mapping[str, object]) -> None:
    for name in names:
        register = profile.registers.get(name)
        if register is not None and register.unit not in known:
            rule = f"needs {' or '.join(known)} as the unit of {name}, not {register.unit!r}"
            raise _error(profile, f"registers.{name}.unit", rule)


def _error(profile: Profile, key: str, rule: str) -> ProfileError:
    return profile.text.error(key, f"adapter {profile.adapter} {rule}")
