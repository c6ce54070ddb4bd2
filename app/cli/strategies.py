"""The command that compares tracking strategies over a day, with the real controller on a virtual clock."""

from datetime import datetime, time, timedelta
from typing import Annotated
from zoneinfo import ZoneInfo

import typer

from app.cli.local_day import local_day
from app.show.strategy_day import strategy_day
from app.show.strategy_told import StrategyDay
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.programs.examples import ALEXANDRU_TABLE_3
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.strategy import (
    Continuous,
    Deadband,
    EncoderDeadband,
    Interval,
    IntervalAim,
    Stepped,
    Strategy,
)
from app.tracker.values.mode import Mode

HELD = Orientation(180.0, 45.0)
COMPARED: tuple[tuple[str, Strategy], ...] = (
    ("continuous", Continuous()),
    ("deadband 0.5 degrees", Deadband()),
    ("deadband 10 of 3600 counts", EncoderDeadband()),
    ("interval 10 min, middle", Interval(10)),
    ("interval 10 min, now", Interval(10, IntervalAim.NOW)),
    ("interval 60 min, middle", Interval(60)),
    ("Alexandru's Table 3", Stepped(ALEXANDRU_TABLE_3)),
)
COLUMNS = (
    "strategy",
    "moves",
    "greatest error, deg",
    "mean error, deg",
    "travel azimuth, deg",
    "travel elevation, deg",
)


def strategies(
    lat: Annotated[float, typer.Option(help="Latitude, degrees, north positive.")],
    lon: Annotated[float, typer.Option(help="Longitude, degrees, east positive.")],
    date: Annotated[str, typer.Option(help="Local day, as 2026-06-21.")],
    time_zone: Annotated[str, typer.Option(help="IANA time zone of the day.")] = "UTC",
) -> None:
    """Print moves, errors and travel of every strategy over a day, as a table."""
    begin = datetime.combine(local_day(date), time(), ZoneInfo(time_zone))
    typer.echo(f"| {' | '.join(COLUMNS)} |")
    typer.echo("| --- |" + " ---: |" * (len(COLUMNS) - 1))
    for name, strategy in COMPARED:
        config = TrackerConfig("T1", "Tracker 1", strategy=strategy)
        end = begin + timedelta(days=1)
        told = strategy_day(config, Pointing(), Location(lat, lon), Mode.DUAL, HELD, begin, end)
        typer.echo(_row(name, told))


def _row(name: str, told: StrategyDay) -> str:
    errors = (told.largest_error_deg, told.mean_error_deg)
    shown = " | ".join("the sun is never up" if error is None else f"{error:.3f}" for error in errors)
    return (
        f"| {name} | {told.moves} | {shown} | {told.travel_azimuth_deg:.0f} | "
        f"{told.travel_elevation_deg:.0f} |"
    )
