"""One study: its progress, and once it is done its table, pictures and files."""

from typing import Annotated

from fastapi import Query
from fastapi.responses import StreamingResponse
from starlette.requests import Request
from starlette.responses import Response

from app.studies.folder import StudyStatus
from app.studies.request import CLEAR_SKIES, Fidelity, LightModel, StudyRequest
from app.studies.result import CaseResult, StudyResult, curves_csv, table_csv
from app.web.contexts import Link
from app.web.deps import PanelDep
from app.web.languages.dates import day_and_month, spelled
from app.web.late_routes import page_router
from app.web.study_contexts import StudyPage, StudyView
from app.web.ui.formats import UNKNOWN, decimals, words
from app.web.ui.frame import site_frame
from app.web.ui.heatmap import heat_map
from app.web.ui.plot import Curve, Plot, bar_plot, line_plot
from app.web.ui.render import go, page
from app.web.ui.studies import TRANSPOSITIONS

router = page_router(prefix="/studies")
MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
HOUR_MARKS = tuple(float(hour) for hour in range(0, 25, 3))
MOST_CURVES = 9
CSV = {"Content-Disposition": 'attachment; filename="study.csv"'}


@router.get("/{study_id}")
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
        frame=site_frame(request, state.title, back=Link("Studies", "/studies")),
        state=state,
        asked=asked,
        settings=_settings(asked, result),
        result=result,
        view=_view(study_id, result, case, day) if result else None,
    )
    return page(request, context, block="body")


@router.post("/{study_id}/remove")
async def remove(request: Request, study_id: str, built: PanelDep) -> Response:
    """Cancel a study that is under way, or delete one that has ended."""
    cancelled = await built.studies.remove(study_id)
    return go(request, f"/studies/{study_id}" if cancelled else "/studies")


@router.get("/{study_id}/table.csv")
def table(study_id: str, built: PanelDep) -> Response:
    """Return the table of cases as a file."""
    found = built.studies.folder.result(study_id)
    return Response(table_csv(found), media_type="text/csv", headers=CSV)


@router.get("/{study_id}/curves.csv")
def curves(study_id: str, built: PanelDep) -> Response:
    """Return the curves of the days as a file."""
    found = built.studies.folder.result(study_id)
    return StreamingResponse(curves_csv(found), media_type="text/csv", headers=CSV)


def _settings(asked: StudyRequest, result: StudyResult | None) -> tuple[tuple[str, str], ...]:
    """Return what the study was asked, in the words of the report."""
    place = result.location if result else asked.location
    module, costs = asked.module, asked.costs
    light = asked.weather_file if asked.light is LightModel.WEATHER else CLEAR_SKIES[asked.light]
    sky = dict(TRANSPOSITIONS)[asked.around.transposition]
    step = result.step_min if result else asked.step_min
    fidelity = "ideal drives" if asked.fidelity is Fidelity.IDEAL else "controller simulation"
    return (
        (
            "Location",
            f"{abs(place.latitude_deg):.4f}° {'north' if place.latitude_deg >= 0.0 else 'south'}, "
            f"{abs(place.longitude_deg):.4f}° {'east' if place.longitude_deg >= 0.0 else 'west'}, "
            f"{place.altitude_m:g} m",
        ),
        ("Days", f"{words(asked.span)}, {asked.on}, a value every {step} min, {fidelity}"),
        ("Irradiance", f"{light}; sky model {sky}; albedo {asked.around.albedo:g}"),
        ("Fixed panel", f"azimuth {asked.held.azimuth_deg:g}°, elevation {asked.held.elevation_deg:g}°"),
        (
            "Panels",
            f"{module.power_w:g} W, losses {module.losses_percent:g} %, {100 * module.per_kelvin:g} %/K",
        ),
        (
            "Drives",
            f"{costs.degree_wh:g} Wh/°, {costs.start_wh:g} Wh per start, {costs.standby_w:g} W standby",
        ),
        ("Strategies", f"deadband {asked.deadband_deg:g}°, interval {asked.interval_min} min"),
    )


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
        heat=heat_map(f"In the panel plane, {shown.label}", result.days, shown.heat_wm2)
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
    title = f"Irradiance in the panel plane, {spelled(shown.curves[at].on)}"
    return line_plot(title, _hour_axis(result), "W/m²", HOUR_MARKS, lines)


def _panel(result: StudyResult, shown: CaseResult, at: int) -> Plot:
    curve = shown.curves[at]
    south = result.location.latitude_deg < 0.0
    azimuth_deg = [value - 360.0 if south and value > 180.0 else value for value in curve.azimuth_deg]
    lines: list[Curve] = [
        ("azimuth", result.hours, azimuth_deg),
        ("elevation", result.hours, curve.elevation_deg),
    ]
    title = f"Panel orientation, {shown.label}, {spelled(curve.on)}"
    return line_plot(title, _hour_axis(result), "degrees", HOUR_MARKS, lines)


def _months(result: StudyResult, shown: CaseResult) -> Plot:
    kinds = [("Fixed", result.cases[0].months_kwh)]
    if shown is not result.cases[0]:
        kinds.append((shown.label, shown.months_kwh))
    return bar_plot("Electric energy of each month", "month", "kWh", MONTHS, kinds)


def _hour_axis(result: StudyResult) -> str:
    offset = f"{result.utc_offset_h:+g}".replace("-", "−")
    return f"hour of the day, standard time (UTC{offset})"
