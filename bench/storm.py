"""A field in its worst minutes: how late ticks come, and how soon every tracker does what it must

The product runs as its users start it (`heliopanel serve`), with trackers that are prepared in its database:
homed, tracking, with simulated drives of its own; those of a line hang on a program of its own, behind a
gateway or on a paced serial line. The controller asks the system for real-time scheduling, which only root
gets: without it other programs of the computer delay its ticks, and the figures are theirs too.
"""

import asyncio
import tempfile
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from app.link.messages import MachineUnreachable
from app.tracker.settings.config import DriveKind
from bench.table import Row, at_most, must_hold
from tests.machine.field import Line
from tests.soak.rigs import fieldwork
from tests.soak.rigs.fieldwork import Size as FieldSize
from tests.soak.rigs.fieldwork import Trial

COMMAND = "python -m bench storm"
LATEST_MS = 50.0
AT_ONCE_S, LOST_WITHIN_S, BACK_WITHIN_S, READY_WITHIN_S = 1.0, 2.0, 5.0, 20.0
TICKS = 12_000
WATCHDOG_TICKS = 3
"""A drive behind a gateway must be told something before its watchdog stops it, also at one tick a second."""
BAUD_RATE = 115_200
FIELDS = (FieldSize(100, 100, TICKS), FieldSize(500, 1000, TICKS))
LARGEST = FieldSize(1000, 1000, TICKS)
EVERYTHING = ("wind", "stop", "sunrise", "web", "tcp", "rtu", "serial")


@dataclass(frozen=True, slots=True)
class Size:
    """The fields that are tried with what, the one that is started, what hangs on a line or looks on."""

    fields: tuple[FieldSize, ...] = FIELDS
    trials: tuple[str, ...] = EVERYTHING
    largest: FieldSize = LARGEST
    behind_a_gateway: int = 64
    on_a_serial_line: int = 14
    viewers: int = 20
    sunrise_in_s: float = 60.0


SMALL = Size((FieldSize(4, 100, 40),), ("wind", "tcp"), FieldSize(8, 1000, 8), behind_a_gateway=3)


def measure(size: Size = Size()) -> list[Row]:
    """Return a row for every trial of every field."""
    return asyncio.run(_rows(size))


async def _rows(size: Size) -> list[Row]:
    rows = [
        await _tried(f"{name}, {field}", TRIALS[name](size, field))
        for field in size.fields
        for name in size.trials
        if _fits(name, field)
    ]
    return [*rows, *await _largest(size.largest)]


async def _tried(name: str, trial: Awaitable[Row]) -> Row:
    """Return the row of a trial; one that came to nothing is missed, and the others go on."""
    try:
        return await trial
    except (AssertionError, MachineUnreachable, TimeoutError) as why:
        told = str(why).partition("\n")[0] or type(why).__name__
        return must_hold(name, told, "it is done", COMMAND, holds=False)


def _fits(name: str, field: FieldSize) -> bool:
    """Return whether a trial can be made: at one tick a second a watchdog of a serial line would trip."""
    return name != "serial" or field.tick_s < 0.5


async def _wind(_: Size, field: FieldSize) -> Row:
    return _row(f"wind over the limit, {field}", await fieldwork.storm(field), AT_ONCE_S)


async def _stop(_: Size, field: FieldSize) -> Row:
    return _row(f"Stop all, {field}", await fieldwork.stop_all(field), AT_ONCE_S)


async def _sunrise(size: Size, field: FieldSize) -> Row:
    trial = await fieldwork.sunrise(field, ahead_s=size.sunrise_in_s)
    return _row(f"sunrise, {field}", trial, AT_ONCE_S + 0.1 * field.tick_s)


async def _web(size: Size, field: FieldSize) -> Row:
    trial = await fieldwork.web_restart(field, viewers=size.viewers)
    return _row(f"web process killed in a storm, {size.viewers} viewers, {field}", trial, AT_ONCE_S)


async def _tcp(size: Size, field: FieldSize) -> Row:
    return await _gateway(size, field, DriveKind.MODBUS_TCP, "Modbus TCP")


async def _rtu(size: Size, field: FieldSize) -> Row:
    return await _gateway(size, field, DriveKind.MODBUS_RTU_OVER_TCP, "RTU over TCP")


async def _gateway(size: Size, field: FieldSize, kind: DriveKind, spoken: str) -> Row:
    watchdog_ms = max(500, WATCHDOG_TICKS * field.tick_ms)
    with tempfile.TemporaryDirectory() as folder:
        line = fieldwork.gateway(size.behind_a_gateway, Path(folder), kind, watchdog_ms=watchdog_ms)
        return await _lost(
            f"loss and return of {line.drives} drives behind a gateway ({spoken})", field, line
        )


async def _serial(size: Size, field: FieldSize) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        line = fieldwork.serial_line(size.on_a_serial_line, Path(folder), BAUD_RATE)
        return await _lost(f"loss and return of {line.drives} drives at {BAUD_RATE} baud", field, line)


TRIALS: Mapping[str, Callable[[Size, FieldSize], Awaitable[Row]]] = {
    "wind": _wind,
    "stop": _stop,
    "sunrise": _sunrise,
    "web": _web,
    "tcp": _tcp,
    "rtu": _rtu,
    "serial": _serial,
}


async def _lost(name: str, field: FieldSize, line: Line) -> Row:
    trial = await fieldwork.loss_of_a_line(field, line)
    return _row(f"{name}, {field}", trial, max(LOST_WITHIN_S, 4.0 * field.tick_s), BACK_WITHIN_S)


async def _largest(field: FieldSize) -> list[Row]:
    steady, ready_s = await fieldwork.start(field)
    return [
        at_most(f"start, {field}, web process and controller ready", ready_s, READY_WITHIN_S, "s", COMMAND),
        _row(f"steady, {field}", steady, None),
        _row(f"wind over the limit, {field}", await fieldwork.storm(field), AT_ONCE_S),
    ]


def _row(name: str, trial: Trial, within_s: float | None, back_within_s: float | None = None) -> Row:
    """Return a row of how late ticks came, unless something else came too late."""
    ours = f"{trial.what}; {trial.found}"
    for took_s, bound_s in ((trial.took_s, within_s), (trial.back_s, back_within_s)):
        if bound_s is not None and took_s > bound_s:
            return must_hold(name, ours, f"all within {bound_s:g} s", COMMAND, holds=False)
    return at_most(name, trial.found.p999_ms, LATEST_MS, "ms", COMMAND, ours=ours)
