"""The process in which studies are worked out: `python -m app.studies.worker`, a job in, what it tells out.

It alone imports pvlib and pandas, so that panel and machine start without them; ending it cancels its job.
"""

import os
import sys
from pathlib import Path
from time import perf_counter

from app.base.message import told_by
from app.fast.compare import compare
from app.studies.compute import finished, work_out
from app.studies.jobs import (
    JOB,
    TOLD,
    Began,
    CheckWeather,
    CompareSite,
    FindPrograms,
    Job,
    ProgramsFound,
    Refused,
    SiteCompared,
    Studied,
    Told,
    WeatherSeen,
    WorkOut,
)
from app.studies.light import clear_days, weather_days
from app.studies.programs import find_programs
from app.studies.weather import read_weather

KINDLY = 10


def main() -> None:
    """Do the one job that comes in, and tell about it line by line."""
    os.nice(KINDLY)
    try:
        tell(_answer(sys.stdin.buffer.readline()))
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # whoever asked has gone


def _answer(line: bytes) -> Told:
    try:
        return done(JOB.validate_json(line))
    except (ValueError, OSError) as error:
        return Refused(told_by(error))


def done(job: Job) -> Told:
    """Return what a job ends with; a study tells of its progress meanwhile."""
    match job:
        case WorkOut():
            return _study(job)
        case CheckWeather(path):
            seen = read_weather(Path(path))
            yearly_kwhm2 = float(seen.global_wm2.sum()) / 1000.0
            return WeatherSeen(
                seen.format,
                seen.location,
                seen.utc_offset_h,
                yearly_kwhm2,
                filled_hours=seen.filled_hours,
                has_leap_day=seen.has_leap_day,
            )
        case FindPrograms(question):
            return ProgramsFound(find_programs(question))
        case CompareSite(config, location, year, held, sky):
            return SiteCompared(compare(config, location, year, held, sky))


def tell(told: Told) -> None:
    """Write one line to whoever started this process."""
    sys.stdout.buffer.write(TOLD.dump_json(told) + b"\n")
    sys.stdout.buffer.flush()


def _study(job: WorkOut) -> Studied:
    begun = perf_counter()
    asked = job.request
    if job.weather_path is None:
        days = clear_days(asked)
    else:
        days = weather_days(asked, read_weather(Path(job.weather_path), asked.on.year))
    cases = work_out(asked, days, lambda number, of, doing: tell(Began(number, of, doing)))
    return Studied(finished(asked, days, cases, perf_counter() - begun))


if __name__ == "__main__":
    main()
