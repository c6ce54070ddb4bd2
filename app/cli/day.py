"""The commands about one place and time: where the sun stands, and a simulated day."""

import json
from dataclasses import asdict
from datetime import datetime, timedelta
from pathlib import Path
from typing import Annotated

import typer

from app.base.clock import SystemClock
from app.base.instants import read_instant
from app.cli.local_day import local_day
from app.show.simulate import simulate_date, simulate_show_of_date
from app.store.exports import to_csv, to_parquet
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.memory.recording import Frames, RecordingInfo
from app.tracker.settings.config import TrackerConfig
from app.tracker.values.mode import Mode

Latitude = Annotated[float, typer.Option("--lat", help="Latitude, degrees, north positive.")]
Longitude = Annotated[float, typer.Option("--lon", help="Longitude, degrees, east positive.")]


def sun(
    lat: Latitude,
    lon: Longitude,
    at: Annotated[str, typer.Option(help="Instant, ISO 8601 with offset; default is now.")] = "",
    algorithm: Annotated[Algorithm, typer.Option(help="Published algorithm.")] = Algorithm.PSA,
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON at full precision.")] = False,
) -> None:
    """Print where the sun stands."""
    instant = _instant(at)
    found = sun_position(algorithm, Location(lat, lon), instant)
    if as_json:
        told = {
            "at": instant.isoformat(),
            "algorithm": algorithm.value,
            "latitude_deg": lat,
            "longitude_deg": lon,
        }
        typer.echo(json.dumps(told | asdict(found)))
        return
    typer.echo(
        f"{instant:%Y-%m-%d %H:%M:%S %Z}  azimuth {found.azimuth_deg:.4f} deg  "
        f"elevation {found.elevation_deg:.4f} deg  apparent {found.apparent_elevation_deg:.4f} deg"
    )


def simulate(
    lat: Latitude,
    lon: Longitude,
    date: Annotated[str, typer.Option(help="Local day, as 2026-06-21.")],
    out: Annotated[Path, typer.Option(help="File to write; .csv or .parquet.")],
    time_zone: Annotated[str, typer.Option(help="IANA time zone of the day.")] = "UTC",
    mode: Annotated[Mode, typer.Option(help="Tracking mode.")] = Mode.DUAL,
    algorithm: Annotated[Algorithm, typer.Option(help="Published algorithm.")] = Algorithm.PSA,
    step_s: Annotated[float, typer.Option(min=0.1, max=60.0, help="Seconds between ticks.")] = 1.0,
    show_minutes: Annotated[
        float | None, typer.Option(help="Instead, show the day from sunrise to sunset in so many minutes.")
    ] = None,
) -> None:
    """Simulate a day, or a show of it, with the real controller on a virtual clock; write the recording."""
    tracker, place = TrackerConfig("T1", "Tracker 1", algorithm=algorithm), Location(lat, lon)
    day = local_day(date)
    if show_minutes is None:
        step = timedelta(seconds=step_s)
        info, frames = simulate_date(tracker, place, time_zone, day, mode=mode, step=step)
    else:
        length = timedelta(minutes=show_minutes)
        info, frames = simulate_show_of_date(tracker, place, time_zone, day, length, mode=mode)
    _write(out, info, frames)
    typer.echo(f"{len(frames)} frames of {info.title} are in {out}.")


def _write(out: Path, info: RecordingInfo, frames: Frames) -> None:
    """Write a recording in the format that the file's name asks for."""
    match out.suffix.lower():
        case ".csv":
            with out.open("wb") as file:
                file.writelines(to_csv(info, frames))
        case ".parquet":
            out.write_bytes(to_parquet(info, frames))
        case other:
            raise ValueError(f"{other or 'A file without a suffix'} is not known: name it .csv or .parquet.")


def _instant(text: str) -> datetime:
    if not text:
        return SystemClock().now()
    found = read_instant(text)
    if found.tzinfo is None:
        raise ValueError(f"{text} has no time zone: add an offset, such as {text}+03:00 or {text}Z.")
    return found
