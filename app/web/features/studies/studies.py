"""The form of a new study, the list of studies, and the weather files."""

from typing import Annotated

from fastapi import File, Form, UploadFile
from pydantic import BaseModel
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, join, say, told_by, with_format, word
from app.base.permission import Permission
from app.base.zones import day_in
from app.energy.plane import Transposition
from app.link.messages import SiteDetail
from app.studies.folder import WeatherFile
from app.studies.request import (
    CLEAR_SKIES,
    Fidelity,
    LightModel,
    Span,
    StudyMode,
    StudyRequest,
    StudyStrategy,
)
from app.studies.result import MODE_NAMES, STRATEGY_NAMES
from app.tracker.values.typed_numbers import written
from app.web.features.studies.study_contexts import Choice, Options, StudiesPage, StudyOptions
from app.web.features.studies.study_orders import NewStudy
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.whole_forms import CHECKED_ONLY
from app.web.shell import coordinates
from app.web.shell.deps import MachineDep, PanelDep
from app.web.shell.forms import Typed, clean_name
from app.web.shell.frame import site_frame
from app.web.shell.render import go, page

router = page_router(prefix="/studies")

ALTITUDES_M = (-500, 9000)
NUMBERS = (
    ("latitude", "latitude_deg", N_("Latitude"), -90, 90),
    ("longitude", "longitude_deg", N_("Longitude"), -180, 180),
    ("altitude", "altitude_m", N_("Altitude"), *ALTITUDES_M),
    ("azimuth", "azimuth_deg", N_("Fixed azimuth"), 0, 359.999),
    ("elevation", "elevation_deg", N_("Fixed elevation"), -90, 90),
    ("deadband", "deadband_deg", N_("Deadband"), 0.05, 30),
    ("range", "range_deg", N_("Range"), 5, 180),
    ("rows", "rows_ratio", N_("Ground coverage"), 0, 1),
    ("axis_tilt", "axis_tilt_deg", N_("Tilt of the axis"), 0, 90),
    ("albedo", "albedo", N_("Albedo"), 0, 1),
    ("power", "power_w", N_("Power of the panels"), 1, 1e9),
    ("losses", "losses_percent", N_("Losses"), 0, 99),
    ("air", "air_degc", N_("Air"), -60, 60),
    ("wind", "wind_mps", N_("Wind"), 0, 50),
    ("degree", "degree_wh", N_("Energy per degree"), 0, 1e4),
    ("start", "start_wh", N_("Energy per start"), 0, 1e4),
    ("standby", "standby_w", N_("Standby"), 0, 1e4),
)
WHOLE = (("step", "step_min", N_("Step"), 1, 60), ("interval", "interval_min", N_("Interval"), 1, 240))
MEANINGS = {
    "step": N_("A divisor of 60"),
    "elevation": N_("Of the panel's normal: 90 is a level panel."),
    "latitude": N_("North is positive."),
    "longitude": N_("East is positive."),
    "range": N_("Single and polar axes"),
    "rows": N_("For rows that backtrack; 0: none."),
    "axis_tilt": N_("Tilted axis"),
    "albedo": N_("Share of irradiance that the ground reflects."),
    "power": "At 1000 W/m², 25 °C",
    "losses": N_("Cables, inverter, soiling."),
    "air": N_("Clear sky"),
    "wind": N_("Clear sky"),
    "degree": N_("Drives"),
    "start": N_("Drives"),
    "standby": N_("Drives"),
}
FILE = "file:"
SPANS: Options = (
    (Span.DAY, N_("One day")),
    (Span.TWELVE_DAYS, N_("12 representative days")),
    (Span.YEAR, N_("The whole year")),
)
CLEAR: Options = tuple((model, say("Clear sky: {name}", name=name)) for model, name in CLEAR_SKIES.items())
TRANSPOSITIONS: Options = (
    (Transposition.HAY_DAVIES, N_("Hay and Davies")),
    (Transposition.PEREZ, N_("Perez 1990")),
    (Transposition.ISOTROPIC, N_("Isotropic")),
)
FIDELITIES: Options = (
    (Fidelity.IDEAL, N_("Ideal drives")),
    (Fidelity.CONTROLLER, N_("Controller simulation, one day, with the tracker's mount and limits")),
)


class StudyForm(BaseModel):
    """The form as it was typed; all texts."""

    title: str = ""
    date: str = ""
    span: str = Span.TWELVE_DAYS
    step: str = "10"
    modes: Annotated[list[str], CHECKED_ONLY] = []
    strategies: Annotated[list[str], CHECKED_ONLY] = []
    fidelity: str = Fidelity.IDEAL
    tracker: str = ""
    light: str = LightModel.INEICHEN
    transposition: str = Transposition.HAY_DAVIES
    latitude: str = ""
    longitude: str = ""
    altitude: str = "0"
    azimuth: str = "180"
    elevation: str = "45"
    deadband: str = "1"
    interval: str = "20"
    range: str = "60"
    rows: str = "0"
    axis_tilt: str = "20"
    albedo: str = "0.2"
    power: str = "1000"
    losses: str = "14"
    air: str = "20"
    wind: str = "1"
    degree: str = "0.02"
    start: str = "0.005"
    standby: str = "0.5"


BEGUN = StudyForm(
    modes=[StudyMode.FIXED, StudyMode.AZIMUTH, StudyMode.ELEVATION_LEAST, StudyMode.DUAL],
    strategies=[StudyStrategy.CONTINUOUS, StudyStrategy.DEADBAND],
)
NAMES = tuple(name for name in StudyForm.model_fields if name not in ("modes", "strategies"))


def hints() -> dict[str, str]:
    """Return what every number of the form means, its range and its usual value."""
    spans = [(name, least, most) for name, _, _, least, most in (*NUMBERS, *WHOLE)]
    return {name: _hint(name, least, most) for name, least, most in spans}


def _hint(name: str, least: float, most: float) -> str:
    meaning, usual = MEANINGS.get(name, ""), getattr(StudyForm(), name)
    low, high = with_format(least, ".10g"), with_format(most, ".10g")
    span = (
        say("{low} to {high}, usual {usual}.", low=low, high=high, usual=usual)
        if usual
        else say("{low} to {high}.", low=low, high=high)
    )
    between = " " if meaning.endswith(".") else ". "
    return join(between, (word(meaning), span)) if meaning else span


@router.get("")
@needs(Permission.READ)
async def studies(request: Request, machine: MachineDep, built: PanelDep) -> Response:
    """Show the form for a study and the studies so far."""
    detail = await machine.detail()
    today = day_in("UTC", built.site_now())
    form = BEGUN.model_copy(update={"date": today.isoformat(), **_site_values(detail)})
    return await _answer(request, detail, built, form, Typed(_texts(form)))


@router.get("/list")
@needs(Permission.READ)
async def studies_list(request: Request, machine: MachineDep, built: PanelDep) -> Response:
    """Renew the list of studies alone, while one of them is under way."""
    detail = await machine.detail()
    form = BEGUN.model_copy()
    return await _answer(request, detail, built, form, Typed(_texts(form)), block="list")


@router.post("")
@needs(Permission.SIMULATE)
async def begin(
    request: Request, machine: MachineDep, built: PanelDep, form: Annotated[StudyForm, Form()]
) -> Response:
    """Begin the study and open its page."""
    detail = await machine.detail()
    typed = Typed(_texts(form))
    wanted = _read(typed, form, detail)
    if wanted is None:
        return await _answer(request, detail, built, form, typed, status=422)
    state = await built.studies.start(wanted)
    return go(request, f"/studies/{state.study_id}")


@router.post("/weather")
@needs(Permission.SIMULATE)
async def upload(request: Request, built: PanelDep, file: Annotated[UploadFile, File()]) -> Response:
    """Keep a weather file that can be used."""
    try:
        await built.studies.add_weather(file.filename or "", await file.read())
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    return go(request, "/studies#weather")


@router.post("/weather/{name}/delete")
@needs(Permission.SIMULATE)
async def delete_weather(request: Request, name: str, built: PanelDep) -> Response:
    """Remove a weather file."""
    await run_in_threadpool(built.studies.folder.delete_weather, name)
    return go(request, "/studies#weather")


def _texts(form: StudyForm) -> dict[str, str]:
    return {name: str(getattr(form, name)) for name in NAMES}


def _site_values(detail: SiteDetail) -> dict[str, str]:
    """Return the site's own place, and the panel that faces its noon sun over the year."""
    known = detail.site.location
    if known is None:
        return {}
    return {
        "latitude": f"{known.latitude_deg:.6g}",
        "longitude": f"{known.longitude_deg:.6g}",
        "altitude": written(known.altitude_m, ALTITUDES_M[1]),
        "azimuth": "180" if known.latitude_deg >= 0.0 else "0",
        "elevation": f"{90.0 - abs(known.latitude_deg):.4g}",
    }


def _read(typed: Typed, form: StudyForm, detail: SiteDetail) -> StudyRequest | None:
    """Return the study; None where something typed is wrong, with the reasons kept."""
    typed.texts |= coordinates.spread(typed.texts)
    day = typed.day("date", N_("Date"))
    title = typed.read("title", clean_name, "")
    values: dict[str, object] = {
        target: coordinates.number(typed, name, label, least, most)
        for name, target, label, least, most in NUMBERS
    }
    values |= {target: typed.whole(name, label, least, most) for name, target, label, least, most in WHOLE}
    if typed.errors:
        return None
    name = form.light.removeprefix(FILE) if form.light.startswith(FILE) else None
    values |= {
        "date": day,
        "title": title,
        "span": form.span,
        "modes": form.modes,
        "strategies": form.strategies,
        "fidelity": form.fidelity,
        "tracker_id": form.tracker or None,
        "light": LightModel.WEATHER if name else form.light,
        "weather_file": name,
        "transposition": form.transposition,
    }
    try:
        return NewStudy.model_validate(values).request(detail)
    except ValueError as error:
        sentence = told_by(error)
        typed.errors["step" if sentence.startswith("The step is") else "span"] = sentence
        return None


async def _answer(
    request: Request,
    detail: SiteDetail,
    built: PanelDep,
    form: StudyForm,
    typed: Typed,
    *,
    status: int = 200,
    block: str = "form",
) -> Response:
    files = tuple(await run_in_threadpool(built.studies.folder.weather_files))
    listed = tuple(await run_in_threadpool(built.studies.states))
    context = StudiesPage(
        frame=site_frame(request, N_("Energy studies")),
        form=typed.form(NAMES),
        hints=hints(),
        options=_options(detail, form, files),
        studies=listed,
        files=files,
        any_open=any(one.is_open for one in listed),
    )
    return page(request, context, block=block, status=status)


def _options(detail: SiteDetail, form: StudyForm, files: tuple[WeatherFile, ...]) -> StudyOptions:
    stored = tuple(
        (f"{FILE}{one.name}", say("Weather file {name} ({format})", name=one.name, format=one.seen.format))
        for one in files
    )
    known = ((name, f"{name} {one.state.config.name}") for name, one in detail.trackers.items())
    return StudyOptions(
        spans=SPANS,
        lights=CLEAR + stored,
        transpositions=TRANSPOSITIONS,
        fidelities=FIDELITIES,
        trackers=(("", N_("None")), *known),
        modes=tuple(Choice(mode, name, mode in form.modes) for mode, name in MODE_NAMES.items()),
        strategies=tuple(
            Choice(one, word(name.capitalize()), one in form.strategies)
            for one, name in STRATEGY_NAMES.items()
        ),
    )
