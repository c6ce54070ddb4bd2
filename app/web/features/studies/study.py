"""One study: its progress, and once it is done its table, pictures and files."""

from typing import Annotated

from fastapi import Query
from fastapi.responses import StreamingResponse
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, Message, say
from app.base.permission import Permission
from app.studies.folder import StudyStatus
from app.studies.result import CaseResult, StudyResult, curves_csv, table_csv
from app.web.charts.axis import DAY_HOURS, MONTHS, angle_step
from app.web.charts.heatmap import heat_map
from app.web.charts.plot import Curve, Plot, bar_plot, line_plot
from app.web.features.studies.study_contexts import StudyPage, StudyView
from app.web.features.studies.study_settings import settings
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.languages.dates import day_and_month, spelled
from app.web.shell.contexts import Link
from app.web.shell.deps import PanelDep
from app.web.shell.formats import UNKNOWN, decimals
from app.web.shell.frame import site_frame
from app.web.shell.render import go, page

router = page_router(prefix="/studies")
MOST_CURVES = 9
CSV = {"Content-Disposition": 'attachment; filename="study.csv"'}


@router.get("/{study_id}")
@needs(Permission.READ)
def study(
    request: Request,
    study_id: str,
    built: PanelDep,
    case: Annotated[int, Query(ge=0, le=100)] = 0,
    day: Annotated[int | None, Query(ge=0, le=366)] = None,
) -> Response:
    """Show how far a study is, or what it found."""
    folder, state = built.studies.folder, built.studies.state(study_id)
    asked = folder.request(study_id)
    result = folder.result(study_id) if state.status is StudyStatus.DONE else None
    context = StudyPage(
        frame=site_frame(request, state.title, back=Link(N_("Studies"), "/studies")),
        state=state,
        asked=asked,
        settings=settings(asked, result),
        result=result,
        view=_view(study_id, result, case, day) if result else None,
    )
    return page(request, context, block="body")


@router.post("/{study_id}/remove")
@needs(Permission.SIMULATE)
async def remove(request: Request, study_id: str, built: PanelDep) -> Response:
    """Cancel a study that is under way, or delete one that has ended."""
    cancelled = await built.studies.remove(study_id)
    return go(request, f"/studies/{study_id}" if cancelled else "/studies")


@router.get("/{study_id}/table.csv")
@needs(Permission.READ, ticketed=True)
def table(study_id: str, built: PanelDep) -> Response:
    """Return the table of cases as a file."""
    found = built.studies.folder.result(study_id)
    return Response(table_csv(found), media_type="text/csv", headers=CSV)


@router.get("/{study_id}/curves.csv")
@needs(Permission.READ, ticketed=True)
def curves(study_id: str, built: PanelDep) -> Response:
    """Return the curves of the days as a file."""
    found = built.studies.folder.result(study_id)
    return StreamingResponse(curves_csv(found), media_type="text/csv", headers=CSV)


def _view(study_id: str, result: StudyResult, case: int, day: int | None) -> StudyView:
    chosen = min(case, len(result.cases) - 1) or _best(result)
    shown = result.cases[chosen]
    dates = [curve.on for curve in shown.curves]
    brightest = max(range(len(dates)), key=lambda index: sum(shown.curves[index].plane_wm2))
    at = brightest if day is None else min(day, len(dates) - 1)
    root = f"/studies/{study_id}?case={chosen}"
    days = tuple(
        Link(day_and_month(on), f"{root}&day={index}", index == at) for index, on in enumerate(dates)
    )
    return StudyView(
        chosen=chosen,
        case=shown,
        days=days if len(days) > 1 else (),
        curves=_curves(result, shown, at),
        panel=_panel(result, shown, at),
        months=_months(result, shown) if shown.months_kwh else None,
        heads=tuple(day_and_month(on) for on in result.days) if len(result.days) == len(MONTHS) else MONTHS,
        gains=_gains(result),
        heat=heat_map(say("In the panel plane, {label}", label=shown.label), result.days, shown.heat_wm2)
        if shown.heat_wm2
        else None,
    )


def _best(result: StudyResult) -> int:
    """Return the case with the greatest net gain, which is shown until another is chosen."""
    return max(range(len(result.cases)), key=lambda index: (index > 0, result.cases[index].net_gain_percent))


def _gains(result: StudyResult) -> tuple[tuple[str, tuple[str, ...]], ...]:
    """Return each case's gain against the fixed panel in every month, in percent."""
    fixed = result.cases[0].months_kwh
    return tuple(
        (
            case.label,
            tuple(
                decimals(100.0 * (kwh / still - 1.0), 1) if still > 0.0 else UNKNOWN
                for kwh, still in zip(case.months_kwh, fixed, strict=True)
            ),
        )
        for case in result.cases[1:]
        if fixed
    )


def _curves(result: StudyResult, shown: CaseResult, at: int) -> Plot:
    """Return the light in the plane of every mode on one day; of several strategies the shown one's."""
    drawn = [result.cases[0], *(one for one in result.cases[1:] if one.strategy is shown.strategy)]
    lines: list[Curve] = [
        (one.label, result.hours, [float(value) for value in one.curves[at].plane_wm2])
        for one in drawn[:MOST_CURVES]
    ]
    title = say("Irradiance in the panel plane, {on}", on=spelled(shown.curves[at].on))
    return line_plot(title, _hour_axis(result), "W/m²", DAY_HOURS, lines)


def _panel(result: StudyResult, shown: CaseResult, at: int) -> Plot:
    curve = shown.curves[at]
    south = result.location.latitude_deg < 0.0
    azimuth_deg = [value - 360.0 if south and value > 180.0 else value for value in curve.azimuth_deg]
    lines: list[Curve] = [
        ("azimuth", result.hours, azimuth_deg),
        ("elevation", result.hours, curve.elevation_deg),
    ]
    title = say("Panel orientation, {label}, {on}", label=shown.label, on=spelled(curve.on))
    return line_plot(title, _hour_axis(result), "degrees", DAY_HOURS, lines, steps=angle_step)


def _months(result: StudyResult, shown: CaseResult) -> Plot:
    kinds: list[tuple[str, tuple[float, ...]]] = [(N_("Fixed"), result.cases[0].months_kwh)]
    if shown is not result.cases[0]:
        kinds.append((shown.label, shown.months_kwh))
    return bar_plot(N_("Electric energy of each month"), "month", "kWh", MONTHS, kinds)


def _hour_axis(result: StudyResult) -> Message:
    offset = f"{result.utc_offset_h:+g}".replace("-", "−")
    return say("hour of the day, standard time (UTC{offset})", offset=offset)
