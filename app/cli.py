"""The command line: serve and its two processes, the sun, simulations, a drive to practise on, backup."""

import json
import os
import signal
import socket
import sys
from dataclasses import asdict
from datetime import datetime, timedelta
from pathlib import Path
from typing import Annotated

import typer

from app.build import VERSION
from app.cli_audit import audit
from app.cli_drives import drive_sim, fault_proxy
from app.cli_profiles import drive
from app.cli_strategies import strategies
from app.cli_study import compare, study
from app.cli_tls import tls
from app.cli_sun import accuracy, reproduce
from app.cli_users import users
from app.clock import SystemClock
from app.drives.drive import DriveError
from app.gateway.sunspec_map import map_table, sunspec_map
from app.machine.lock import AlreadyRunning, holder
from app.machine.main import run as run_machine
from app.machine.supervisor import end_with_parent, supervise
from app.settings import Settings, SettingsWrong, read_settings
from app.show.simulate import simulate_date, simulate_show_of_date
from app.store.backup import backup as back_up
from app.store.engine import open_reader
from app.store.exports import to_csv, to_parquet
from app.store.restore import Restored, RestorePending, request_restore
from app.store.store import StoreFailed
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.commands import CommandRejected
from app.tracker.config import TrackerConfig
from app.tracker.mode import Mode
from app.tracker.recording import Frames, RecordingInfo
from app.web.main import run as run_web

FAILED = 2
FORESEEN = (SettingsWrong, AlreadyRunning, StoreFailed, DriveError, CommandRejected, ValueError, OSError)

cli = typer.Typer(
    name="heliopanel",
    help="Commissions a solar tracker in the browser and keeps it on the sun.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)

cli.add_typer(drive)
cli.add_typer(users)
cli.add_typer(audit)
cli.add_typer(tls)
cli.command()(drive_sim)
cli.command()(strategies)
cli.command()(fault_proxy)
cli.command()(accuracy)
cli.command("papers")(reproduce)
cli.command()(study)
cli.command()(compare)

Supervised = Annotated[int | None, typer.Option(hidden=True, help="Process id of the supervisor.")]
Latitude = Annotated[float, typer.Option("--lat", help="Latitude, degrees, north positive.")]
Longitude = Annotated[float, typer.Option("--lon", help="Longitude, degrees, east positive.")]


@cli.command()
def serve(
    *,
    insecure_lan: Annotated[
        bool,
        typer.Option("--insecure-lan", help="Listen on a network without a certificate; every page warns."),
    ] = False,
) -> None:
    """Run the controller service and the panel, and start either again when it dies."""
    if insecure_lan:
        os.environ["HELIOPANEL_INSECURE_LAN"] = "1"
    settings = read_settings()
    typer.echo(
        f"Heliopanel {VERSION}: open {settings.scheme}://{_bracketed(settings.host)}:{settings.port} (Ctrl-C ends it)"
    )
    raise typer.Exit(supervise(settings))


@cli.command()
def machine(supervised: Supervised = None) -> None:
    """Run the controller service alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    run_machine(read_settings())


@cli.command()
def web(supervised: Supervised = None) -> None:
    """Run the panel alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    settings = read_settings()
    _check_port(settings)
    run_web(settings)


@cli.command()
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


@cli.command()
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
    day = datetime.fromisoformat(date).date()
    if show_minutes is None:
        step = timedelta(seconds=step_s)
        info, frames = simulate_date(tracker, place, time_zone, day, mode=mode, step=step)
    else:
        length = timedelta(minutes=show_minutes)
        info, frames = simulate_show_of_date(tracker, place, time_zone, day, length, mode=mode)
    _write(out, info, frames)
    typer.echo(f"{len(frames)} frames of {info.title} are in {out}.")


@cli.command("sunspec-map")
def print_sunspec_map(
    *,
    weather: Annotated[
        bool, typer.Option("--weather", help="With model 307, which comes with weather.")
    ] = False,
) -> None:
    """Print the SunSpec map of the present site as a table."""
    reader = open_reader(read_settings().url)
    try:
        tracker_ids = [state.config.tracker_id for state in reader.trackers()]
    finally:
        reader.close()
    typer.echo(map_table(sunspec_map(tracker_ids, weather=weather)), nl=False)


@cli.command()
def backup(file: Annotated[Path, typer.Argument(help="File to write.")]) -> None:
    """Write everything that is stored into one file; the machine may run."""
    info = back_up(read_settings().url, file)
    typer.echo(f"The backup is in {file} ({info.size_bytes} bytes).")


@cli.command()
def restore(file: Annotated[Path, typer.Argument(help="File that `backup` wrote.")]) -> None:
    """Bring back what a backup holds; a running machine stops its drives and starts again on it."""
    settings = read_settings()
    match request_restore(file, settings.url, settings.data_dir):
        case Restored(backup=found):
            typer.echo(f"The backup of {found.site_name} is restored.")
        case RestorePending(backup=found):
            running = holder(settings.data_dir)
            if running is not None:
                os.kill(running, signal.SIGTERM)
            typer.echo(
                f"The backup of {found.site_name} is handed over: the controller service stops its drives "
                "now and restores it when it starts again."
            )


@cli.command()
def version() -> None:
    """Print the version."""
    typer.echo(VERSION)


def main() -> None:
    """Run the command line; what was foreseen to fail is one sentence and exit code 2."""
    try:
        cli()
    except FORESEEN as error:
        typer.echo(str(error) or type(error).__name__, err=True)
        sys.exit(FAILED)


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
    found = datetime.fromisoformat(text)
    if found.tzinfo is None:
        raise ValueError(f"{text} has no time zone: add an offset, such as {text}+03:00 or {text}Z.")
    return found


def _check_port(settings: Settings) -> None:
    """Raise `SettingsWrong` if another program listens where the panel shall listen."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    with socket.socket(family) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((settings.host, settings.port))
        except OSError as error:
            raise SettingsWrong(
                f"The panel cannot listen on {settings.host} port {settings.port}: {error.strerror}. "
                "Stop the program that uses it, or choose another port with HELIOPANEL_PORT."
            ) from error


def _bracketed(host: str) -> str:
    return f"[{host}]" if ":" in host else host


if __name__ == "__main__":
    main()
