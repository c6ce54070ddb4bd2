"""The command that works out an energy study, in the same worker process as the panel's."""

import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated

import typer

from app.base.adapter import adapter
from app.base.extras import need
from app.base.own import own_process
from app.cli.local_day import local_day
from app.energy.motion import DriveCosts
from app.energy.plane import Around, Transposition
from app.fast.comparison import ClearSky, Comparison
from app.studies.jobs import JOB, TOLD, Began, CompareSite, Job, Refused, SiteCompared, Studied, Told, WorkOut
from app.studies.request import LightModel, Module, Span, StudyMode, StudyRequest, StudyStrategy
from app.studies.result import StudyResult, table_csv
from app.sun.position import Location
from app.tracker.settings.config import Orientation, TrackerConfig

HEAD = ("case", "kWh/m2", "kWh", "gain %", "drives kWh", "net kWh", "net gain %", "moves", "travel deg")
DIED = "The process that worked the study out ended without a result; what it printed above says more."

Latitude = Annotated[float, typer.Option(help="Latitude, degrees, north positive.")]
Longitude = Annotated[float, typer.Option(help="Longitude, degrees, east positive.")]
Altitude = Annotated[float, typer.Option(help="Metres above the sea.")]
TimeZone = Annotated[str, typer.Option(help="IANA time zone; days are cut in its standard time.")]
Strategies = Annotated[list[StudyStrategy] | None, typer.Option(help="One or several. [default: continuous]")]
WeatherFile = Annotated[Path | None, typer.Option(help="Instead, a weather file: TMY3, EPW or PVGIS CSV.")]
Sky = Annotated[Transposition, typer.Option(help="How the sky's light is spread.")]
HeldElevation = Annotated[
    float | None, typer.Option(help="Held elevation of the normal. [default: 90 less the latitude]")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print everything that was found as JSON.")]


def study(
    lat: Latitude,
    lon: Longitude,
    date: Annotated[str, typer.Option(help="The day, or any day of the year, as 2026-06-21.")],
    altitude: Altitude = 0.0,
    time_zone: TimeZone = "UTC",
    span: Annotated[Span, typer.Option(help="A day, the twelve representative days, or a year.")] = Span.YEAR,
    mode: Annotated[list[StudyMode] | None, typer.Option(help="One or several. [default: all]")] = None,
    strategy: Strategies = None,
    step: Annotated[int, typer.Option(help="Minutes between instants; a divisor of 60.")] = 10,
    light: Annotated[LightModel, typer.Option(help="A clear-sky model.")] = LightModel.INEICHEN,
    weather: WeatherFile = None,
    sky: Sky = Transposition.HAY_DAVIES,
    azimuth: Annotated[float | None, typer.Option(help="Held azimuth. [default: to the equator]")] = None,
    elevation: HeldElevation = None,
    deadband: Annotated[float, typer.Option(help="Degrees.")] = 1.0,
    interval: Annotated[int, typer.Option(help="Minutes.")] = 20,
    *,
    as_json: AsJson = False,
    as_csv: Annotated[bool, typer.Option("--csv", help="Print the table as CSV.")] = False,
) -> None:
    """Compare what modes and strategies collect in a day, twelve days or a year."""
    place = Location(lat, lon, altitude)
    request = StudyRequest(
        title="",
        location=place,
        time_zone=time_zone,
        span=span,
        on=local_day(date),
        modes=tuple(mode or StudyMode),
        strategies=tuple(strategy or (StudyStrategy.CONTINUOUS,)),
        held=_held(place, azimuth, elevation),
        step_min=step,
        light=LightModel.WEATHER if weather else light,
        weather_file=weather.name if weather else None,
        around=Around(sky),
        module=Module(),
        costs=DriveCosts(),
        deadband_deg=deadband,
        interval_min=interval,
    )
    result = _work_out(WorkOut(request, str(weather) if weather else None))
    if as_json:
        typer.echo(adapter(StudyResult).dump_json(result).decode())
    elif as_csv:
        typer.echo(table_csv(result), nl=False)
    else:
        typer.echo(_table(result))


def compare(
    lat: Latitude,
    lon: Longitude,
    year: Annotated[int, typer.Option(help="The year that is worked out.")],
    altitude: Altitude = 0.0,
    turbidity: Annotated[float, typer.Option(min=1.0, max=10.0, help="Linke turbidity of the air.")] = 3.0,
    *,
    as_json: AsJson = False,
) -> None:
    """Compare what each mode collects in a clear year, and what each deadband costs in motion and error."""
    place = Location(lat, lon, altitude)
    config = TrackerConfig("T1", "Tracker 1")
    question = CompareSite(config, place, year, _held(place, None, None), ClearSky(altitude, turbidity))
    for told in _told(question):
        match told:
            case SiteCompared(comparison):
                line = TOLD.dump_json(told).decode() if as_json else "\n".join(_at_a_glance(comparison))
                typer.echo(line)
                return
            case Refused(reason):
                raise ValueError(reason)
            case _:
                pass
    raise ValueError(DIED)


def _at_a_glance(found: Comparison) -> Iterator[str]:
    """Yield the comparison as lines of text."""
    yield f"Clear year {found.year}, kWh/m2 and more than fixed"
    for mode in found.modes:
        yield f"{mode.mode:<12}{mode.collected_kwhm2:8.0f}{mode.gain_pct:8.1f} %"
    yield f"Deadband, a day of {found.days}: moves, azimuth and elevation travel, greatest and rms error"
    for row in found.deadbands:
        travel = f"{row.azimuth_travel_deg:7.0f} deg{row.elevation_travel_deg:7.0f} deg"
        error = f"{row.worst_off_deg:7.2f} deg{row.rms_off_deg:7.2f} deg"
        yield f"{row.deadband_deg:<8g}{row.moves_a_day:8.0f}{travel}{error}"


def _held(place: Location, azimuth: float | None, elevation: float | None) -> Orientation:
    towards_deg = 180.0 if place.latitude_deg >= 0.0 else 0.0
    return Orientation(
        towards_deg if azimuth is None else azimuth,
        90.0 - abs(place.latitude_deg) if elevation is None else elevation,
    )


def _work_out(job: WorkOut) -> StudyResult:
    """Return what the worker found, telling of its progress meanwhile."""
    for told in _told(job):
        match told:
            case Began(done, of, doing) if doing:
                typer.echo(f"{done + 1} of {of}: {doing}", err=True)
            case Studied(result):
                return result
            case Refused(reason):
                raise ValueError(reason)
            case _:
                pass
    raise ValueError(DIED)


def _told(job: Job) -> Iterator[Told]:
    need("studies")
    command = own_process("app.studies.worker")
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:  # noqa: S603 - ours
        if process.stdin is None or process.stdout is None:
            raise TypeError("A worker has pipes.")
        process.stdin.write(JOB.dump_json(job) + b"\n")
        process.stdin.close()
        for line in process.stdout:
            yield TOLD.validate_json(line)


def _table(result: StudyResult) -> str:
    """Return the comparison as lines of text in columns."""
    rows = [HEAD]
    rows += [
        (
            case.label,
            f"{case.insolation_kwhm2:.2f}",
            f"{case.energy_kwh:.2f}",
            f"{case.gross_gain_percent:.2f}",
            f"{case.drives_kwh:.3f}",
            f"{case.net_kwh:.2f}",
            f"{case.net_gain_percent:.2f}",
            f"{case.moves}",
            f"{case.travel_deg:.0f}",
        )
        for case in result.cases
    ]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEAD))]
    lines = [
        "  ".join(text.rjust(width) if column else text.ljust(width) for column, (text, width) in cells)
        for cells in (enumerate(zip(row, widths, strict=True)) for row in rows)
    ]
    days = "1 day" if len(result.days) == 1 else f"{len(result.days)} days"
    head = f"{result.source}, {days}, every {result.step_min} min, for 1 kW of panels"
    return "\n".join([head, "", *lines])
