"""What a study is asked: the site, the days, the light, what follows the sun how, and what it is paid by."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from enum import StrEnum
from types import MappingProxyType
from typing import Final

from app.base.message import N_, join, say
from app.base.names import tidy, unseen
from app.energy.motion import DriveCosts
from app.energy.plane import Around
from app.sun.position import Location
from app.tracker.memory.memory import Pointing
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.settings.stepped import StepProgram

FIRST_YEAR, LAST_YEAR = 1950, 2049
LONGEST_TITLE = 120
STEPS_MIN = (1, 2, 3, 4, 5, 6, 10, 12, 15, 20, 30, 60)
MOST_CASES = 24
MOST_VALUES = 6_000_000
TWELVE = 12


class Span(StrEnum):
    """Which days are worked out."""

    DAY = "day"
    TWELVE_DAYS = "twelve-days"
    YEAR = "year"


class LightModel(StrEnum):
    """Where the light comes from: a clear-sky model of pvlib's, or a weather file."""

    INEICHEN = "ineichen"
    SOLIS = "simplified-solis"
    HAURWITZ = "haurwitz"
    WEATHER = "weather-file"


CLEAR_SKIES: Final[Mapping[LightModel, str]] = MappingProxyType(
    {
        LightModel.INEICHEN: N_("Ineichen and Perez, Linke turbidity of the location"),
        LightModel.SOLIS: N_("simplified Solis"),
        LightModel.HAURWITZ: N_("Haurwitz, split by Erbs"),
    }
)


class StudyMode(StrEnum):
    """What is mounted how and follows what."""

    FIXED = "fixed"
    AZIMUTH = "azimuth"
    ELEVATION = "elevation"
    ELEVATION_LEAST = "elevation-least-incidence"
    DUAL = "dual"
    EQUATORIAL = "equatorial"
    HORIZONTAL_AXIS = "horizontal-axis"
    TILTED_AXIS = "tilted-axis"
    VERTICAL_AXIS = "vertical-axis"


class StudyStrategy(StrEnum):
    """When it moves."""

    CONTINUOUS = "continuous"
    DEADBAND = "deadband"
    INTERVAL = "interval"
    PROGRAM = "program"


class Fidelity(StrEnum):
    """Whether drives are ideal, or the real controller is run with a simulated drive."""

    IDEAL = "ideal"
    CONTROLLER = "controller"


OF_THE_CONTROLLER = (StudyMode.FIXED, StudyMode.AZIMUTH, StudyMode.ELEVATION, StudyMode.DUAL)


@dataclass(frozen=True, slots=True)
class Module:
    """Panels: power at 1000 W/m2 and 25 degrees Celsius, change a kelvin, losses up to the meter."""

    power_w: float = 1000.0
    per_kelvin: float = -0.0035
    losses_percent: float = 14.0
    air_degc: float = 20.0
    wind_mps: float = 1.0

    def __post_init__(self) -> None:
        if not 1.0 <= self.power_w <= 1e9:
            raise ValueError(N_("The power of the panels lies between 1 W and 1 GW."))
        if not -0.02 <= self.per_kelvin <= 0.0:
            raise ValueError(N_("The temperature coefficient must be between -2 and 0 percent per kelvin."))
        if not 0.0 <= self.losses_percent < 100.0:
            raise ValueError(N_("The losses must be at least 0 and below 100 percent."))
        if not -60.0 <= self.air_degc <= 60.0 or not 0.0 <= self.wind_mps <= 50.0:
            raise ValueError(
                N_(
                    "The air temperature must be between -60 and 60 degrees Celsius, the "
                    "wind speed at most 50 m/s."
                )
            )


@dataclass(frozen=True, slots=True)
class StudyRequest:
    """One study. `on` is the day, or any day of the year.

    `held` is where the panel stands in modes that hold an angle. `rows_ratio` above zero has single axes
    backtrack between rows of that ground coverage; `range_deg` bounds the rotation of single and polar axes.
    `tracker` and `pointing` are needed only at the controller's fidelity. Raises `ValueError` with a sentence
    for a study that cannot be, or would be too large.
    """

    title: str
    location: Location
    time_zone: str
    span: Span
    on: date
    modes: tuple[StudyMode, ...]
    strategies: tuple[StudyStrategy, ...]
    held: Orientation
    step_min: int = 10
    fidelity: Fidelity = Fidelity.IDEAL
    light: LightModel = LightModel.INEICHEN
    weather_file: str | None = None
    around: Around = field(default_factory=Around)
    module: Module = field(default_factory=Module)
    costs: DriveCosts = field(default_factory=DriveCosts)
    deadband_deg: float = 1.0
    interval_min: int = 20
    program: StepProgram | None = None
    rows_ratio: float = 0.0
    range_deg: float = 60.0
    axis_tilt_deg: float = 20.0
    tracker: TrackerConfig | None = None
    pointing: Pointing = field(default_factory=Pointing)

    def __post_init__(self) -> None:
        wrong = (*_general(self), *_settings(self), *_size(self), *_controller(self))
        if wrong:
            raise ValueError(join(" ", wrong))

    @property
    def cases(self) -> tuple[tuple[StudyMode, StudyStrategy], ...]:
        """Return every mode with every strategy; the fixed panel, with none, is always the first."""
        moving = [mode for mode in self.modes if mode is not StudyMode.FIXED]
        followed = [(mode, strategy) for mode in moving for strategy in self.strategies]
        return ((StudyMode.FIXED, StudyStrategy.CONTINUOUS), *followed)

    @property
    def day_count(self) -> int:
        """Return the number of days that are worked out."""
        return {Span.DAY: 1, Span.TWELVE_DAYS: TWELVE, Span.YEAR: 365}[self.span]


def _general(asked: StudyRequest) -> list[str]:
    found: list[str] = []
    if fault := unseen(tidy(asked.title)):
        found.append(fault)
    elif len(asked.title) > LONGEST_TITLE:
        found.append(
            say("The title has at most {longest_title} printable characters.", longest_title=LONGEST_TITLE)
        )
    if not FIRST_YEAR <= asked.on.year <= LAST_YEAR:
        found.append(
            say(
                "Choose a year between {first_year} and {last_year}.",
                first_year=FIRST_YEAR,
                last_year=LAST_YEAR,
            )
        )
    if asked.step_min not in STEPS_MIN:
        found.append(say("The step is one of {join} minutes.", join=join(", ", map(str, STEPS_MIN))))
    if not asked.strategies:
        found.append(N_("Choose at least one strategy."))
    if len(set(asked.modes)) < len(asked.modes) or len(set(asked.strategies)) < len(asked.strategies):
        found.append(N_("Enter each mode and each strategy only once."))
    if (asked.light is LightModel.WEATHER) != (asked.weather_file is not None):
        found.append(N_("Enter a weather file if, and only if, the irradiance comes from one."))
    return found


def _settings(asked: StudyRequest) -> list[str]:
    found: list[str] = []
    if not 0.05 <= asked.deadband_deg <= 30.0:
        found.append(N_("The deadband lies between 0.05 and 30 degrees."))
    if not 1 <= asked.interval_min <= 240:
        found.append(N_("The interval lies between 1 and 240 minutes."))
    if StudyStrategy.PROGRAM in asked.strategies and asked.program is None:
        found.append(N_("The strategy 'program' needs a program: give one, or a tracker that has one."))
    if not 0.0 <= asked.rows_ratio <= 1.0:
        found.append(N_("The ground coverage ratio of rows lies between 0 (no rows) and 1."))
    if not 5.0 <= asked.range_deg <= 180.0:
        found.append(N_("The range of single and polar axes lies between 5 and 180 degrees to either side."))
    if not 0.0 <= asked.axis_tilt_deg <= 90.0:
        found.append(N_("The tilt of the tilted axis lies between 0 and 90 degrees."))
    return found


def _size(asked: StudyRequest) -> list[str]:
    if asked.step_min not in STEPS_MIN:
        return []
    cases, values = len(asked.cases), asked.day_count * 24 * 60 // asked.step_min
    if cases > MOST_CASES:
        return [
            say(
                "A study compares at most {most_cases} cases, not {cases}: take fewer modes or strategies.",
                most_cases=MOST_CASES,
                cases=cases,
            )
        ]
    if cases * values > MOST_VALUES:
        return [
            say(
                "{cases} cases of {values} instants are too many (at most {most_values} in all): "
                "choose a longer step, fewer days, or fewer modes and strategies.",
                cases=cases,
                values=values,
                most_values=MOST_VALUES,
            )
        ]
    return []


def _controller(asked: StudyRequest) -> list[str]:
    if asked.fidelity is not Fidelity.CONTROLLER:
        return []
    found: list[str] = []
    if asked.span is not Span.DAY:
        found.append(
            N_("A study with the controller's control covers one day: choose a day, or ideal drives.")
        )
    if asked.tracker is None:
        found.append(N_("A study with the controller's control needs a tracker: choose one."))
    if not set(asked.modes) <= set(OF_THE_CONTROLLER):
        found.append(
            N_(
                "A study with the controller's control has the modes fixed, azimuth, elevation, and "
                "dual of the tracker's own mount: omit the others, or choose ideal drives."
            )
        )
    if asked.light is LightModel.WEATHER:
        found.append(N_("A study with the controller's control has a clear sky: choose a clear-sky model."))
    return found
