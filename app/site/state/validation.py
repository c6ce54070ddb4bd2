"""What an engineer may set: sentences for everything that is not plausible."""

import re
from collections.abc import Iterable
from dataclasses import replace
from typing import assert_never

from app.base.hosts import host_fault
from app.base.message import N_, join, say, told_by
from app.base.names import clean
from app.base.zones import shown_zone, zones_missing
from app.drives.scaled import check_ratio
from app.tracker.settings.axes import AxisConfig
from app.tracker.settings.config import LONGEST_NAME, DriveConfig, DriveKind, MountKind, TrackerConfig
from app.tracker.settings.declared import wrong
from app.tracker.settings.strategy import Stepped
from app.tracker.values.reason import Reason

NO_ZONES = Reason(
    "zones_missing",
    N_("The controller's computer has no time zone data, so all times are shown in UTC."),
    N_("Install tzdata (the system's package or Python's), then restart Heliopanel."),
)
TRACKER_ID = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,15}")
WIDEST_RANGE_DEG = 720.0
RTU_UNITS = (1, 247)
"""Unit 0 is the broadcast, which nobody answers and which is never used."""


def check_name(name: str) -> str:
    """Return a name as it is stored, or raise `ValueError`."""
    plain = clean(name)
    if not 1 <= len(plain) <= LONGEST_NAME:
        raise ValueError(
            say("A name has 1 to {longest_name} printable characters.", longest_name=LONGEST_NAME)
        )
    return plain


def with_clean_names(config: TrackerConfig) -> TrackerConfig:
    """Return a configuration with its names as they are stored, or raise `ValueError`."""
    regions = tuple(replace(one, name=clean(one.name)) for one in config.machine.regions)
    strategy = config.strategy
    if isinstance(strategy, Stepped):
        strategy = Stepped(replace(strategy.program, name=clean(strategy.program.name)))
    machine = replace(config.machine, regions=regions)
    return replace(config, name=check_name(config.name), machine=machine, strategy=strategy)


def check_time_zone(name: str) -> str:
    """Return the name of a time zone that exists, or raise `ValueError`."""
    if shown_zone(name) == name:
        return name
    if zones_missing():
        raise ValueError(
            say("{message} {hint} Until then choose UTC.", message=NO_ZONES.message, hint=NO_ZONES.hint)
        )
    raise ValueError(
        say(
            "There is no time zone {name}. Use a name of the IANA database, such as Europe/Istanbul.",
            name=repr(name),
        )
    )


def check_config(config: TrackerConfig) -> None:
    """Raise `ValueError` with every sentence that says what is wrong with a configuration."""
    found = [*_wrong_names(config), *_wrong_numbers(config), *_wrong_drive(config.drive)]
    if found:
        raise ValueError(join(" ", found))


def _wrong_names(config: TrackerConfig) -> Iterable[str]:
    if TRACKER_ID.fullmatch(config.tracker_id) is None:
        yield N_("A tracker's id is a letter followed by up to 15 letters, digits, - or _, such as T1.")
    try:
        check_name(config.name)
    except ValueError as error:
        yield told_by(error)


def _wrong_numbers(config: TrackerConfig) -> Iterable[str]:
    yield from wrong(config)
    if config.in_position_deg > config.deadband_deg:
        yield N_("The tolerance for being in position must not exceed the deadband.")
    for axis in (config.azimuth, config.elevation):
        if axis.maximum_deg - axis.minimum_deg > WIDEST_RANGE_DEG:
            yield N_("An axis range above 720 degrees is not plausible; check the soft limits.")
    if config.mount.kind is MountKind.AZIMUTH_ELEVATION:
        yield from _wrong_park(config)


def _wrong_park(config: TrackerConfig) -> Iterable[str]:
    """Yield what is wrong with a park position; other mounts park as near to it as they can."""
    if not _reachable(config.azimuth, config.park.azimuth_deg):
        yield N_("The park position's azimuth lies outside the soft limits. Change it in the settings first.")
    if not config.elevation.contains(config.park.elevation_deg):
        yield N_(
            "The park position's elevation lies outside the soft limits. Change it in the settings first."
        )


def _reachable(axis: AxisConfig, azimuth_deg: float) -> bool:
    return any(axis.contains(azimuth_deg + turns * 360.0) for turns in (-2, -1, 0, 1, 2))


def check_drive(drive: DriveConfig) -> None:
    """Raise `ValueError` with the first thing that is wrong with how a drive is connected."""
    for sentence in _wrong_drive(drive):
        raise ValueError(sentence)


def _wrong_drive(drive: DriveConfig) -> Iterable[str]:
    match drive.kind:
        case DriveKind.SIMULATED:
            yield from _wrong_ratios(drive)
            return
        case DriveKind.MODBUS_TCP | DriveKind.MODBUS_RTU_OVER_TCP:
            fault = host_fault(drive.host)
            if fault is not None:
                yield fault
            if not 1 <= drive.port <= 65535:
                yield N_("The drive's TCP port must lie between 1 and 65535.")
        case DriveKind.MODBUS_RTU:
            if not drive.serial.port.strip():
                yield N_("Choose the serial port that the drive is connected to.")
        case _ as never:
            assert_never(never)
    low, high = (0, 255) if drive.kind is DriveKind.MODBUS_TCP else RTU_UNITS
    if not all(low <= unit <= high for unit in drive.units):
        yield say("The drive's unit id must lie between {low} and {high}.", low=low, high=high)


def _wrong_ratios(drive: DriveConfig) -> Iterable[str]:
    for own in (drive.azimuth, drive.elevation):
        try:
            check_ratio(own.gear_ratio)
        except ValueError as error:
            yield told_by(error)
