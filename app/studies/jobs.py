"""What a worker process is asked and what it tells: one JSON line in, JSON lines out."""

from dataclasses import dataclass
from datetime import date
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import ConfigDict, Discriminator, TypeAdapter

from app.base.message import N_, join, say, with_format
from app.energy.optimiser import MOST_STEPS
from app.fast.comparison import ClearSky, Comparison
from app.studies.request import FIRST_YEAR, LAST_YEAR, LightModel, StudyRequest
from app.studies.result import StudyResult
from app.sun.position import Location
from app.tracker.settings.config import Orientation, TrackerConfig


class ProgramLight(StrEnum):
    """The radiation that a step program is judged by."""

    MELISS = "meliss"
    INEICHEN = "ineichen"
    SOLIS = "simplified-solis"


CLEAR_SKIES = {ProgramLight.INEICHEN: LightModel.INEICHEN, ProgramLight.SOLIS: LightModel.SOLIS}


@dataclass(frozen=True, slots=True)
class ProgramQuestion:
    """Which step programs to find: the day and place, the light, the mechanism and what its motion costs.

    `turbidity` counts for Meliss's model alone. With `window`, energy counts from 6 h to 18 h solar time
    only, as in C. Alexandru's paper. Without `tilt_deg` the tilt is optimised too.
    """

    location: Location
    on: date
    most_steps: int = 12
    range_deg: float = 60.0
    step_s: float = 0.0
    light: ProgramLight = ProgramLight.MELISS
    turbidity: float = 3.0
    window: bool = False
    tilt_deg: float | None = None
    area_m2: float = 1.26
    efficiency: float = 0.15
    degree_wh: float = 0.0
    move_wh: float = 0.0

    def __post_init__(self) -> None:
        wrong = _program_errors(self)
        if wrong:
            raise ValueError(join(" ", wrong))


@dataclass(frozen=True, slots=True)
class ProgramRow:
    """The best program of one number of steps; hours are solar, hour angles positive in the morning."""

    steps: int
    electric_wh: float
    further_wh: float
    drives_wh: float
    net_wh: float
    tilt_deg: float
    travel_deg: float
    starts_h: tuple[float, ...]
    angles_deg: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ProgramAnswer:
    """The table of best programs and what to compare them with.

    `best` is the number of steps that leaves most after the drives are paid. `fixed_wh` is the panel that
    stands at noon at the latitude's tilt, `continuous_wh` the one that follows within the range.
    """

    question: ProgramQuestion
    rows: tuple[ProgramRow, ...]
    best: int
    fixed_wh: float
    continuous_wh: float
    declination_deg: float
    start_h: float
    end_h: float
    hours: tuple[float, ...]
    beam_wm2: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class WorkOut:
    """Work out a study; `weather_path` is its weather file where it has one."""

    request: StudyRequest
    weather_path: str | None
    do: Literal["study"] = "study"


@dataclass(frozen=True, slots=True)
class CheckWeather:
    """Read a weather file and tell what it is."""

    path: str
    do: Literal["weather"] = "weather"


@dataclass(frozen=True, slots=True)
class FindPrograms:
    """Find the best step programs."""

    question: ProgramQuestion
    do: Literal["programs"] = "programs"


@dataclass(frozen=True, slots=True)
class CompareSite:
    """Compare the modes and deadbands of a site at a glance; `held` is what the fixed panel faces."""

    config: TrackerConfig
    location: Location
    year: int
    held: Orientation
    sky: ClearSky
    do: Literal["compare"] = "compare"

    def __post_init__(self) -> None:
        if not FIRST_YEAR <= self.year <= LAST_YEAR:
            raise ValueError(
                say(
                    "The year lies between {first_year} and {last_year}.",
                    first_year=FIRST_YEAR,
                    last_year=LAST_YEAR,
                )
            )


Job = Annotated[WorkOut | CheckWeather | FindPrograms | CompareSite, Discriminator("do")]


@dataclass(frozen=True, slots=True)
class Began:
    """A case of a study began, or the last one ended."""

    done: int
    of: int
    doing: str
    tell: Literal["began"] = "began"


@dataclass(frozen=True, slots=True)
class Studied:
    """The study is worked out."""

    result: StudyResult
    tell: Literal["studied"] = "studied"


@dataclass(frozen=True, slots=True)
class WeatherSeen:
    """The file can be used: what it is and where it is from.

    `filled_hours` had missing values, which are interpolated; 29 February is left out where there is one.
    """

    format: str
    location: Location
    utc_offset_h: float
    global_kwhm2: float
    tell: Literal["weather"] = "weather"
    filled_hours: int = 0
    has_leap_day: bool = False


@dataclass(frozen=True, slots=True)
class ProgramsFound:
    """The best step programs."""

    answer: ProgramAnswer
    tell: Literal["programs"] = "programs"


@dataclass(frozen=True, slots=True)
class SiteCompared:
    """What modes and deadbands are worth at the site."""

    comparison: Comparison
    tell: Literal["compared"] = "compared"


@dataclass(frozen=True, slots=True)
class Refused:
    """It cannot be done; the sentence says why."""

    reason: str
    tell: Literal["refused"] = "refused"


Told = Annotated[
    Began | Studied | WeatherSeen | ProgramsFound | SiteCompared | Refused, Discriminator("tell")
]
LATE = ConfigDict(defer_build=True)
JOB: TypeAdapter[Job] = TypeAdapter(Job, config=LATE)
TOLD: TypeAdapter[Told] = TypeAdapter(Told, config=LATE)


def _program_errors(asked: ProgramQuestion) -> list[str]:
    tilt_deg = 0.0 if asked.tilt_deg is None else asked.tilt_deg
    bounds = (
        (N_("The year"), asked.on.year, FIRST_YEAR, LAST_YEAR, ""),
        (N_("The number of steps"), asked.most_steps, 1, MOST_STEPS, ""),
        (N_("The range to either side of noon"), asked.range_deg, 5.0, 120.0, " degrees"),
        (N_("The duration of a step"), asked.step_s, 0.0, 3600.0, " seconds"),
        (N_("The turbidity"), asked.turbidity, 1.0, 10.0, ""),
        (N_("The tilt (below 0: toward north)"), tilt_deg, -90.0, 90.0, " degrees"),
        (N_("The panel's area"), asked.area_m2, 0.01, 1e6, " m2"),
        (N_("The panel's efficiency"), asked.efficiency, 0.001, 1.0, ""),
        (N_("The energy for a degree"), asked.degree_wh, 0.0, 1e4, " Wh"),
        (N_("The energy for a move"), asked.move_wh, 0.0, 1e5, " Wh"),
    )
    return [
        say(
            "{name} lies between {least} and {most}{unit}.",
            name=name,
            least=with_format(least, "g"),
            most=with_format(most, "g"),
            unit=unit,
        )
        for name, value, least, most, unit in bounds
        if not least <= value <= most
    ]
