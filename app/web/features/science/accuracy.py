"""How far every sun algorithm is from NREL SPA, for the site or the globe."""

from typing import Annotated
from urllib.parse import urlencode

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, say, with_format
from app.base.permission import Permission
from app.sun.accuracy import FIRST_YEAR, LAST_YEAR, AlgorithmError, Question, Sight, Survey, survey
from app.sun.accuracy_words import title
from app.sun.algorithms import PUBLISHED
from app.sun.position import Location
from app.web.charts.axis import MONTHS, angle_step, degrees, within
from app.web.charts.logchart import LogChart, log_chart
from app.web.features.science.science_contexts import AccuracyPage, AccuracyResult, AccuracyRow
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep
from app.web.shell.forms import Typed, Unreadable
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/accuracy")
NAMES = ("place", "from", "to", "samples")
SITE, GLOBE = "site", "globe"
MOST_SAMPLES = 200_000
MONTH_DAYS = 365.25 / 12
MOST_PARTS = 6


@router.get("")
@needs(Permission.READ)
async def accuracy(
    request: Request,
    built: PanelDep,
    place: str = "",
    from_year: Annotated[str, Query(alias="from")] = "2000",
    to: str = "2049",
    samples: str = "20000",
) -> Response:
    """Show the question; once asked, the table and the curves."""
    latest = built.machine.latest()
    location = latest.location if latest else None
    known = {"place": place or (SITE if location else GLOBE), "from": from_year, "to": to, "samples": samples}
    typed = Typed(known)
    asked = _read(typed, location)
    wanted = bool(place) and asked is not None
    found = await built.simulations.work_out(survey, asked) if wanted and asked else None
    context = AccuracyPage(
        frame=site_frame(request, N_("Accuracy")),
        form=typed.form(NAMES),
        places=_places(location),
        result=_result(found) if found else None,
        load="" if place else f"/accuracy?{urlencode(known)}",
    )
    return page(request, context, block="body", status=422 if typed.errors else 200)


def _read(typed: Typed, location: Location | None) -> Question | None:
    place = typed.read("place", lambda text: _place(text, location), None)
    first = typed.whole("from", N_("First year"), FIRST_YEAR, LAST_YEAR)
    last = typed.whole("to", N_("Last year"), FIRST_YEAR, LAST_YEAR)
    samples = typed.whole("samples", N_("Samples"), 1_000, MOST_SAMPLES)
    if not typed.errors and last < first:
        typed.errors["to"] = N_("Last year must not be before the first year.")
    return None if typed.errors else Question(place, first, last, samples)


def _place(text: str, location: Location | None) -> Location | None:
    if text == GLOBE:
        return None
    if text == SITE and location is not None:
        return location
    raise Unreadable(
        N_("Location: save the site's location first, in step 1 of commissioning, or choose the globe.")
    )


def _places(location: Location | None) -> tuple[tuple[str, str], ...]:
    globe = (GLOBE, N_("The globe, latitude −65° to 65°"))
    if location is None:
        return (globe,)
    here = say(
        "The site, {latitude_deg}°, {longitude_deg}°",
        latitude_deg=with_format(location.latitude_deg, ".2f"),
        longitude_deg=with_format(location.longitude_deg, ".2f"),
    )
    return ((SITE, here), globe)


def _result(found: Survey) -> AccuracyResult:
    return AccuracyResult(
        title(found), _query(found), tuple(_row(error) for error in found.errors), _charts(found)
    )


def _query(found: Survey) -> str:
    """Return what asks the API for the same table."""
    asked = found.question
    wanted = {"start_year": asked.from_year, "end_year": asked.to_year, "samples": asked.samples}
    return urlencode({"globe": "false" if asked.location else "true", **wanted})


def _row(error: AlgorithmError) -> AccuracyRow:
    one, true = PUBLISHED[error.algorithm], error.spreads[Sight.TRUE]
    return AccuracyRow(
        title=one.title,
        source=one.source,
        doi=one.doi,
        expected_deg=one.max_deg,
        max_deg=true.max_deg,
        rms_deg=true.rms_deg,
        seen_max_deg=error.spreads[Sight.APPARENT].max_deg,
        unrefracted_deg=error.spreads[Sight.UNREFRACTED].max_deg,
    )


def _charts(found: Survey) -> tuple[LogChart, ...]:
    names = [PUBLISHED[error.algorithm].title for error in found.errors]
    seasons = [error.over_year.max_deg for error in found.errors]
    heights = [error.over_elevation.max_deg for error in found.errors]
    months = [(MONTH_DAYS * number, name) for number, name in enumerate([*MONTHS, ""])]
    heights_deg = [(mark, degrees(mark)) for mark in within(0.0, 90.0, MOST_PARTS, angle_step)]
    return (
        log_chart(
            N_("Greatest separation from NREL SPA over the year"),
            N_("day of the year, in spans of 5 days"),
            months,
            found.day_of_year,
            list(zip(names, seasons, strict=True)),
        ),
        log_chart(
            N_("Greatest separation from NREL SPA over elevation"),
            N_("true elevation of the sun, in spans of 5°"),
            heights_deg,
            found.elevation_deg,
            list(zip(names, heights, strict=True)),
        ),
    )
