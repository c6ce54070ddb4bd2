"""The algorithms there are, and how far each is from NREL SPA."""

from typing import Annotated, Self

import numpy as np
from fastapi import Query
from pydantic import Field

from app.base.message import told_by
from app.base.permission import Permission
from app.sun.accuracy import AlgorithmError, Profile, Question, Sight, Spread, Survey, survey
from app.sun.accuracy_words import title
from app.sun.algorithms import PUBLISHED, Algorithm
from app.sun.position import Location
from app.sun.trigonometry import Array
from app.web.api.base import REFUSED, TOO_MANY, Output, Page, api_router, whole
from app.web.api.sun import location_of
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep, SnapshotDep

router = api_router(prefix="/sun", tags=["sun"])

Degrees = list[float | None]


class AlgorithmCard(Output):
    """A published algorithm and the error to expect: with the sun up, 2000 to 2049, latitude -65 to 65."""

    algorithm: Algorithm
    title: str
    source: str
    doi: str = Field(description="Empty where there is none.")
    max_deg: float = Field(description="Greatest separation from NREL SPA; for SPA its uncertainty.")
    rms_deg: float = Field(description="Root mean square of it.")


class MeasuredError(Output):
    """The measured separations of one algorithm from NREL SPA, degrees; null where nothing was sampled."""

    algorithm: Algorithm
    title: str
    spreads: dict[Sight, Spread] = Field(
        description="`true`: both without refraction. `apparent`: both with it. `unrefracted`: the true sun "
        "taken for the seen one."
    )
    max_over_year_deg: Degrees
    rms_over_year_deg: Degrees
    max_over_elevation_deg: Degrees
    rms_over_elevation_deg: Degrees

    @classmethod
    def of(cls, error: AlgorithmError) -> Self:
        """Return the errors as the API tells them."""
        return cls(
            algorithm=error.algorithm,
            title=PUBLISHED[error.algorithm].title,
            spreads=error.spreads,
            **_columns("over_year", error.over_year),
            **_columns("over_elevation", error.over_elevation),
        )


class AccuracyReport(Output):
    """A survey of every algorithm; the curves run over `day_of_year` and `elevation_deg`, bin centres."""

    title: str
    location: Location | None = Field(description="Null: the globe, latitude -65 to 65.")
    start_year: int
    end_year: int
    samples: int
    sun_up: int = Field(description="So many of the samples had the sun up and count.")
    day_of_year: list[float]
    elevation_deg: list[float]
    errors: list[MeasuredError]

    @classmethod
    def of(cls, found: Survey) -> Self:
        """Return a survey as the API tells it."""
        asked = found.question
        return cls(
            title=title(found),
            location=asked.location,
            start_year=asked.from_year,
            end_year=asked.to_year,
            samples=asked.samples,
            sun_up=found.sun_up,
            day_of_year=found.day_of_year.tolist(),
            elevation_deg=found.elevation_deg.tolist(),
            errors=[MeasuredError.of(error) for error in found.errors],
        )


@router.get("/algorithms", summary="The algorithms and their errors")
@needs(Permission.READ)
async def read_sun_algorithms() -> Page[AlgorithmCard]:
    """Return every algorithm that can be selected, with its source and the error to expect."""
    return whole(
        AlgorithmCard(
            algorithm=algorithm,
            title=one.title,
            source=one.source,
            doi=one.doi,
            max_deg=one.max_deg,
            rms_deg=one.rms_deg,
        )
        for algorithm, one in PUBLISHED.items()
    )


@router.get("/accuracy", summary="Measure every algorithm against NREL SPA", responses=REFUSED | TOO_MANY)
@needs(Permission.READ)
async def read_sun_accuracy(
    site: SnapshotDep,
    panel: PanelDep,
    globe: Annotated[bool, Query(description="The whole globe instead of the site.")] = False,
    start_year: Annotated[int, Query(ge=1901, le=2099)] = 2000,
    end_year: Annotated[int, Query(ge=1901, le=2099)] = 2049,
    samples: Annotated[int, Query(ge=1000, le=500_000, description="Instants to draw.")] = 50_000,
) -> AccuracyReport:
    """Return the greatest and the root mean square separation, over the year and over elevation too."""
    place = None if globe else location_of(site)
    try:
        asked = Question(place, start_year, end_year, samples)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    return AccuracyReport.of(await panel.simulations.work_out(survey, asked))


def _columns(over: str, profile: Profile) -> dict[str, Degrees]:
    return {f"max_{over}_deg": _numbers(profile.max_deg), f"rms_{over}_deg": _numbers(profile.rms_deg)}


def _numbers(column: Array) -> Degrees:
    return [None if np.isnan(value) else round(value, 6) for value in column.tolist()]
