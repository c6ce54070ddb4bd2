"""The weather of a simulated day: a scenario, or steps by the clock, each of which holds until the next."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timedelta, tzinfo
from itertools import pairwise
from typing import Any

from app.base.message import N_, join, say
from app.sun.position import SunPosition
from app.tracker.values.file_table import FileTable, TableRefused, read_table
from app.tracker.weather.simulated_weather import SPANS, Scenario, SimulatedStation, weather_at
from app.tracker.weather.weather import Weather

TIME = re.compile(r"(\d{1,2}):(\d{2})(?::(\d{2}))?")
LAST_HOUR = 95
MOST_STEPS = 500
CLEAR_SKY = "irradiance_wm2"
"""Without a value the light is that of a clear sky; everything else stays as it was in the step before."""


@dataclass(frozen=True, slots=True)
class WeatherStep:
    """What is made up from a time on: so long after the midnight, by the site's civil clock.

    `values` are by the names of `SimulatedStation`: m/s, percent, degrees, W/m2, kg, degrees Celsius.
    """

    after_midnight: timedelta
    values: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class WeatherDay:
    """Made-up stations, each from an instant on, in order; before the first there is no weather at all."""

    parts: tuple[tuple[datetime, SimulatedStation], ...]

    def at(self, instant: datetime, sun: SunPosition | None) -> Weather | None:
        """Return what is measured at an instant, None before the first part."""
        found = None
        for since, station in self.parts:
            if since > instant:
                break
            found = station
        return None if found is None else weather_at(found, instant, sun)


def midnight_before(instant: datetime, zone: tzinfo) -> datetime:
    """Return when the civil day of an instant began."""
    civil = instant.astimezone(zone)
    return datetime(civil.year, civil.month, civil.day, tzinfo=zone)


def day_of_scenario(scenario: Scenario, begins: str, seed: int, begin: datetime, zone: tzinfo) -> WeatherDay:
    """Return a day that is quiet until a scenario begins by the civil clock, or raise `ValueError`.

    `begin` is when the simulation begins; `begins` counts from the midnight before that, such as `12:00`.
    """
    if scenario is Scenario.MANUAL:
        raise ValueError(N_("Manual weather values are given in steps; choose one of the other scenarios."))
    midnight = midnight_before(begin, zone)
    since = instant_of(after_midnight(begins, N_("The start of the scenario")), midnight, zone)
    quiet = SimulatedStation(seed=seed, begun_at=midnight)
    if since <= midnight:
        return WeatherDay(((midnight, SimulatedStation(scenario, seed, begun_at=midnight)),))
    return WeatherDay(((midnight, quiet), (since, SimulatedStation(scenario, seed, begun_at=since))))


def stepped_day(
    steps: tuple[WeatherStep, ...], midnight: datetime, zone: tzinfo, seed: int = 1
) -> WeatherDay:
    """Return a day of steps; `midnight` is that of its first civil day. Raises `ValueError`."""
    if not 1 <= len(steps) <= MOST_STEPS:
        raise ValueError(say("The weather of a day has 1 to {most_steps} steps.", most_steps=MOST_STEPS))
    if any(later.after_midnight <= earlier.after_midnight for earlier, later in pairwise(steps)):
        raise ValueError(N_("Every step of the weather must come after the one before it."))
    station = SimulatedStation(seed=seed, begun_at=midnight)
    parts = []
    for step in steps:
        station = replace(station, irradiance_wm2=None)
        given: dict[str, Any] = dict(step.values)
        station = replace(station, **given)
        parts.append((instant_of(step.after_midnight, midnight, zone), station))
    return WeatherDay(tuple(parts))


def read_steps(text: str) -> tuple[WeatherStep, ...]:
    """Return the steps of a CSV text with the columns `time` and any of `SPANS`, or raise `ValueError`.

    A time is hours and minutes after the midnight before the begin; 24:00 and more are the next days. An
    empty field leaves the value as it was, and the light to a clear sky.
    """
    table = read_table(text)
    if not table.names:
        raise ValueError(N_("The weather is empty: give a line of names and one line for each step."))
    unknown = [name for name in table.names if name != "time" and name not in SPANS]
    if "time" not in table.names or unknown or len(set(table.names)) != len(table.names):
        known = join(", ", SPANS)
        raise ValueError(
            say("The first line must name the columns: time and any of {known}, each once.", known=known)
        )
    return tuple(_step(table, row, number) for number, row in table.rows)


def _step(table: FileTable, row: tuple[str, ...], number: int) -> WeatherStep:
    if len(row) != len(table.names):
        raise ValueError(
            say(
                "Line {number} of the weather has {row} fields; there must be {names}.",
                number=number,
                row=len(row),
                names=len(table.names),
            )
        )
    fields = dict(zip(table.names, row, strict=True))
    after = after_midnight(fields.pop("time"), say("Line {number} of the weather", number=number))
    return WeatherStep(after, dict(_values(table, fields, number)))


def _values(table: FileTable, fields: Mapping[str, str], number: int) -> Iterator[tuple[str, float]]:
    for name, text in fields.items():
        if not text:
            continue
        try:
            yield name, table.number(text, number, SPANS[name][2])
        except TableRefused:
            raise
        except ValueError as error:
            raise ValueError(
                say(
                    "Line {number} of the weather: {name} must be a number, not {text}.",
                    number=number,
                    name=name,
                    text=repr(text),
                )
            ) from error


def after_midnight(text: str, where: str) -> timedelta:
    """Return the time that `11:30` or `11:30:15` means, or raise `ValueError`."""
    match = TIME.fullmatch(text)
    hour, minute, second = (int(part or 0) for part in match.groups()) if match else (LAST_HOUR + 1, 0, 0)
    if hour > LAST_HOUR or minute > 59 or second > 59:
        raise ValueError(
            say(
                "{where}: give a time such as 11:30, from 00:00 to {last_hour}:59.",
                where=where,
                last_hour=LAST_HOUR,
            )
        )
    return timedelta(hours=hour, minutes=minute, seconds=second)


def instant_of(after: timedelta, midnight: datetime, zone: tzinfo) -> datetime:
    """Return the instant at which the civil clock of the zone shows this time."""
    civil = midnight.astimezone(zone).replace(tzinfo=None) + after
    return civil.replace(tzinfo=zone)
