"""How far each algorithm is from NREL SPA: over a site or the globe, over the year and over elevation.

Instants are drawn uniformly from whole years, places uniformly in latitude and longitude, by a generator with
a fixed seed: the same question has the same answer. Only instants with the sun up by SPA count. Separation is
the angle between two directions, in [0, 180] degrees.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from enum import StrEnum

import numpy as np

from app.base.message import say, with_format
from app.sun.algorithms import Algorithm
from app.sun.position import Location, SunPath, sun_path
from app.sun.trigonometry import PER_DEGREE, PER_RADIAN, Array

SEED = 20260621
LATITUDES = (-65.0, 65.0)
FIRST_YEAR, LAST_YEAR = 1901, 2099
FEWEST, MOST = 1_000, 500_000
INSTANTS_A_PLACE = 500
DAYS_A_YEAR = 365.25
SEASONS, HEIGHTS = 73, 18
YEAR_STEP_DAYS = DAYS_A_YEAR / SEASONS
ELEVATION_STEP_DEG = 90.0 / HEIGHTS
MEASURED = tuple(algorithm for algorithm in Algorithm if algorithm is not Algorithm.SPA)


class Sight(StrEnum):
    """What is compared: the true sun, the seen sun, or the true sun taken for the seen one."""

    TRUE = "true"
    APPARENT = "apparent"
    UNREFRACTED = "unrefracted"


@dataclass(frozen=True, slots=True)
class Question:
    """What to measure: a place, or the globe between two latitudes where it is None, over whole years."""

    location: Location | None = None
    from_year: int = 2000
    to_year: int = 2049
    samples: int = 100_000
    latitudes: tuple[float, float] = LATITUDES

    def __post_init__(self) -> None:
        if not FIRST_YEAR <= self.from_year <= self.to_year <= LAST_YEAR:
            raise ValueError(
                say(
                    "Years must lie between {first_year} and {last_year}, the first not after the last.",
                    first_year=FIRST_YEAR,
                    last_year=LAST_YEAR,
                )
            )
        if not FEWEST <= self.samples <= MOST:
            raise ValueError(
                say(
                    "Choose between {fewest} and {most} samples, not {samples}.",
                    fewest=with_format(FEWEST, ","),
                    most=with_format(MOST, ","),
                    samples=with_format(self.samples, ","),
                )
            )


@dataclass(frozen=True, slots=True)
class Spread:
    """The greatest and the root mean square separation, degrees."""

    max_deg: float
    rms_deg: float


@dataclass(frozen=True, slots=True)
class Profile:
    """The greatest and the root mean square separation by bin, degrees; NaN where nothing was sampled."""

    max_deg: Array
    rms_deg: Array


@dataclass(frozen=True, slots=True)
class AlgorithmError:
    """The errors of one algorithm: by what is compared, and of the true sun by season and by elevation."""

    algorithm: Algorithm
    spreads: dict[Sight, Spread]
    over_year: Profile
    over_elevation: Profile


@dataclass(frozen=True, slots=True)
class Survey:
    """The answer: how many instants counted, the bins' centres, and every algorithm's errors."""

    question: Question
    sun_up: int
    day_of_year: Array
    elevation_deg: Array
    errors: tuple[AlgorithmError, ...]


@dataclass(frozen=True, slots=True)
class Sample:
    """Instants with the sun up at one place, and the sun there by NREL SPA."""

    location: Location
    unix_s: Array
    reference: SunPath


@dataclass(frozen=True, slots=True)
class _Bins:
    """For every sampled instant, the number of its bin over the year and over elevation."""

    season: Array
    height: Array


def separations_deg(azimuth_a: Array, elevation_a: Array, azimuth_b: Array, elevation_b: Array) -> Array:
    """Return the great-circle angle between directions, degrees: `angles.separation_deg` over arrays."""
    a, b = elevation_a * PER_DEGREE, elevation_b * PER_DEGREE
    turned = np.sin((azimuth_a - azimuth_b) * (PER_DEGREE / 2.0)) ** 2
    haversine = np.sin((a - b) / 2.0) ** 2 + np.cos(a) * np.cos(b) * turned
    return np.asarray(2.0 * PER_RADIAN * np.arcsin(np.sqrt(np.clip(haversine, 0.0, 1.0))))


def survey(question: Question, algorithms: Sequence[Algorithm] = MEASURED) -> Survey:
    """Return the separation of each algorithm from NREL SPA.

    Raises `AlgorithmMissing` where pvlib is not installed.
    """
    samples = draw(question)
    bins = _bins(samples)
    return Survey(
        question=question,
        sun_up=sum(len(sample.unix_s) for sample in samples),
        day_of_year=_centres(YEAR_STEP_DAYS, SEASONS),
        elevation_deg=_centres(ELEVATION_STEP_DEG, HEIGHTS),
        errors=tuple(_errors(algorithm, samples, bins) for algorithm in algorithms),
    )


def draw(question: Question) -> tuple[Sample, ...]:
    """Return the sampled instants with the sun up, place by place."""
    random = np.random.default_rng(SEED)
    count = 1 if question.location else max(1, question.samples // INSTANTS_A_PLACE)
    drawn = (_sample(question, random, question.samples // count) for _ in range(count))
    return tuple(sample for sample in drawn if sample.unix_s.size)


def _sample(question: Question, random: "np.random.Generator", count: int) -> Sample:
    location = question.location or Location(
        float(random.uniform(*question.latitudes)), float(random.uniform(-180.0, 180.0))
    )
    begin = datetime(question.from_year, 1, 1, tzinfo=UTC).timestamp()
    end = datetime(question.to_year + 1, 1, 1, tzinfo=UTC).timestamp()
    unix_s = np.floor(random.uniform(begin, end, count))
    path = sun_path(Algorithm.SPA, location, unix_s)
    up = path.elevation_deg > 0.0
    shown = SunPath(path.azimuth_deg[up], path.elevation_deg[up], path.apparent_elevation_deg[up])
    return Sample(location, unix_s[up], shown)


def _bins(samples: Sequence[Sample]) -> _Bins:
    days = np.concatenate([sample.unix_s for sample in samples]) / 86400.0 % DAYS_A_YEAR
    heights = np.concatenate([sample.reference.elevation_deg for sample in samples])
    return _Bins(np.floor(days / YEAR_STEP_DAYS), np.floor(np.minimum(heights, 89.999) / ELEVATION_STEP_DEG))


def _centres(step: float, count: int) -> Array:
    return np.asarray((np.arange(count) + 0.5) * step, dtype=np.float64)


def _errors(algorithm: Algorithm, samples: Sequence[Sample], bins: _Bins) -> AlgorithmError:
    apart = [_apart(algorithm, sample) for sample in samples]
    by_sight = {sight: np.concatenate([one[sight] for one in apart]) for sight in Sight}
    true = by_sight[Sight.TRUE]
    return AlgorithmError(
        algorithm=algorithm,
        spreads={sight: spread_of(by_sight[sight]) for sight in Sight},
        over_year=_profile(true, bins.season, SEASONS),
        over_elevation=_profile(true, bins.height, HEIGHTS),
    )


def _apart(algorithm: Algorithm, sample: Sample) -> dict[Sight, Array]:
    found, sun = sun_path(algorithm, sample.location, sample.unix_s), sample.reference
    pairs = {
        Sight.TRUE: (found.elevation_deg, sun.elevation_deg),
        Sight.APPARENT: (found.apparent_elevation_deg, sun.apparent_elevation_deg),
        Sight.UNREFRACTED: (found.elevation_deg, sun.apparent_elevation_deg),
    }
    return {
        sight: separations_deg(found.azimuth_deg, ours, sun.azimuth_deg, theirs)
        for sight, (ours, theirs) in pairs.items()
    }


def spread_of(apart_deg: Array) -> Spread:
    """Return the greatest and the root mean square of separations."""
    return Spread(float(apart_deg.max()), float(np.sqrt(np.mean(apart_deg**2))))


def _profile(apart_deg: Array, numbers: Array, count: int) -> Profile:
    places = numbers.astype(np.intp)
    greatest = np.full(count, np.nan)
    np.fmax.at(greatest, places, apart_deg)
    how_many = np.bincount(places, minlength=count)
    squares = np.bincount(places, apart_deg**2, minlength=count)
    rms = np.full(count, np.nan)
    np.sqrt(np.divide(squares, how_many, out=rms, where=how_many > 0), out=rms)
    return Profile(greatest, rms)
