"""The best step programs for a day: question, table, pictures, and giving one to a tracker."""

from dataclasses import replace
from typing import Annotated
from urllib.parse import urlencode

from fastapi import Form, Query
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, Word, join, say, told_by
from app.base.permission import Permission
from app.base.zones import day_in
from app.energy.equatorial import DEGREES_AN_HOUR, NOON_H
from app.link.messages import ConfigureTracker, SiteDetail
from app.studies.jobs import ProgramAnswer, ProgramLight, ProgramRow
from app.studies.program_table import programs_csv
from app.tracker.programs.step_table import to_table
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped
from app.web.charts.axis import angle_step
from app.web.charts.plot import Curve, Plot, line_plot
from app.web.features.studies.study_contexts import Options, ProgramView, StepProgramPage
from app.web.features.studies.study_orders import NewProgram, chosen_program
from app.web.http.attachments import BYTE_ORDER_MARK, kept_as
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell import coordinates
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep, PanelDep
from app.web.shell.formats import angle
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/studies/program")
CSV = "text/csv; charset=utf-8"
LIGHTS: Options = (
    (ProgramLight.MELISS, N_("Meliss's clear sky, as in Alexandru's paper")),
    (ProgramLight.INEICHEN, N_("Ineichen and Perez's clear sky at the location")),
    (ProgramLight.SOLIS, N_("Simplified Solis clear sky at the location")),
)
WINDOWS: Options = (
    ("", N_("From sunrise to sunset")),
    ("yes", N_("From 6 h to 18 h solar time, as in the paper")),
)
NUMBERS = (
    ("latitude", "latitude_deg", N_("Latitude"), -90, 90),
    ("longitude", "longitude_deg", N_("Longitude"), -180, 180),
    ("range", "range_deg", N_("Range"), 5, 120),
    ("step_s", "step_s", N_("Step duration"), 0, 3600),
    ("turbidity", "turbidity", N_("Turbidity"), 1, 10),
    ("area", "area_m2", N_("Area"), 0.01, 1e6),
    ("efficiency", "efficiency", N_("Efficiency"), 0.001, 1),
    ("degree", "degree_wh", N_("Energy per degree"), 0, 1e4),
    ("move", "move_wh", N_("Energy per move"), 0, 1e4),
)


class ProgramForm(BaseModel):
    """The question as it was typed; all texts."""

    date: str = ""
    latitude: str = ""
    longitude: str = ""
    most: str = "12"
    range: str = "60"
    step_s: str = "0"
    light: str = ProgramLight.MELISS
    turbidity: str = "3"
    window: str = ""
    tilt: str = ""
    area: str = "1.26"
    efficiency: str = "0.15"
    degree: str = "0.01"
    move: str = "0.2"
    chosen: str = ""


NAMES = tuple(ProgramForm.model_fields)


class UseForm(ProgramForm):
    """A question with the tracker that is to run the chosen program."""

    tracker: str = ""


@router.get("")
@needs(Permission.READ)
async def ask(
    request: Request, machine: MachineDep, built: PanelDep, *, ready: Annotated[bool, Query()] = False
) -> Response:
    """Show the question at once, and the programs as soon as they are worked out."""
    detail = await machine.detail()
    asked = {name: text for name, text in request.query_params.items() if name in NAMES}
    today = day_in("UTC", built.site_now())
    form = ProgramForm(**{"date": today.isoformat(), **_site_values(detail), **asked})
    typed = Typed(form.model_dump())
    wanted = _read(typed)
    awaited = ready or (bool(asked) and "hx-request" in request.headers)
    answer = await _find(typed, wanted, detail, built) if wanted and awaited else None
    context = StepProgramPage(
        frame=site_frame(request, N_("Step program"), back=Link(N_("Studies"), "/studies")),
        form=typed.form(NAMES),
        lights=LIGHTS,
        windows=WINDOWS,
        trackers=tuple((name, f"{name} {one.state.config.name}") for name, one in detail.trackers.items()),
        query=urlencode({name: text for name, text in form.model_dump().items() if name != "chosen"}),
        view=_view(answer, form.chosen) if answer else None,
        load="" if answer or typed.errors else f"/studies/program?{urlencode(form.model_dump())}",
    )
    return page(request, context, block="body", status=422 if typed.errors else 200)


@router.post("/use")
@needs(Permission.CONFIGURE)
async def use(
    press: PressDep, machine: MachineDep, built: PanelDep, form: Annotated[UseForm, Form()]
) -> Response:
    """Have a tracker run the chosen program."""
    detail = await machine.detail()
    config = tracker_of(detail, form.tracker).state.config
    program = _chosen(await _answered(form, detail, built), form)
    press.issued_at = None  # It took a while, and nothing moves by it: this order is never too old.
    await press.send(ConfigureTracker(replace(config, strategy=Stepped(program))))
    return press.answer(
        say(
            "{tracker} now follows the program of {steps} steps.",
            tracker=form.tracker,
            steps=len(program.steps) - 1,
        )
    )


@router.get("/table.csv")
@needs(Permission.READ)
async def table(machine: MachineDep, built: PanelDep, form: Annotated[ProgramForm, Query()]) -> Response:
    """Return the best program of every number of steps as a file."""
    found = await _answered(form, await machine.detail(), built)
    return Response(programs_csv(found), media_type=CSV, headers=kept_as(f"step-programs-{form.date}.csv"))


@router.get("/program.csv")
@needs(Permission.READ)
async def program(machine: MachineDep, built: PanelDep, form: Annotated[ProgramForm, Query()]) -> Response:
    """Return the steps of the chosen program as a file, which the strategy of a tracker reads."""
    chosen = _chosen(await _answered(form, await machine.detail(), built), form)
    named = kept_as(f"program-{len(chosen.steps) - 1}-steps-{form.date}.csv")
    return Response(BYTE_ORDER_MARK + to_table(chosen), media_type=CSV, headers=named)


async def _answered(form: ProgramForm, detail: SiteDetail, built: PanelDep) -> ProgramAnswer:
    """Return the programs that a form asks for, or raise `NotAcceptable` with what is wrong."""
    typed = Typed(form.model_dump())
    wanted = _read(typed)
    if wanted is None:
        raise NotAcceptable(join(" ", typed.errors.values()))
    try:
        return await built.studies.find_programs(wanted.question(detail))
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error


def _chosen(answer: ProgramAnswer, form: ProgramForm) -> StepProgram:
    try:
        return chosen_program(answer, _steps(answer, form.chosen))
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error


async def _find(
    typed: Typed, wanted: NewProgram, detail: SiteDetail, built: PanelDep
) -> ProgramAnswer | None:
    try:
        return await built.studies.find_programs(wanted.question(detail))
    except ValueError as error:
        typed.errors["latitude"] = told_by(error)
        return None


def _site_values(detail: SiteDetail) -> dict[str, str]:
    known = detail.site.location
    if known is None:
        return {"latitude": "45.65", "longitude": "25.6"}
    return {"latitude": f"{known.latitude_deg:.6g}", "longitude": f"{known.longitude_deg:.6g}"}


def _read(typed: Typed) -> NewProgram | None:
    typed.texts |= coordinates.spread(typed.texts)
    values: dict[str, object] = {
        target: coordinates.number(typed, name, label, least, most)
        for name, target, label, least, most in NUMBERS
    }
    values["date"] = typed.day("date", N_("Date"))
    values["most_steps"] = typed.whole("most", N_("Number of steps"), 1, 48)
    if typed.texts["tilt"].strip():
        values["tilt_deg"] = typed.number("tilt", N_("Tilt"), -90, 90)
    if typed.errors:
        return None
    try:
        return NewProgram.model_validate(
            {**values, "light": typed.texts["light"], "window": typed.texts["window"] == "yes"}
        )
    except ValueError:
        typed.errors["light"] = N_("Irradiance: choose one from the list.")
        return None


def _steps(answer: ProgramAnswer, text: str) -> int:
    """Return which number of steps is chosen: the best one where none is, and never none at all."""
    most = answer.rows[-1].steps
    return min(most, max(1, int(text))) if text.isdecimal() else max(1, answer.best)


def _view(answer: ProgramAnswer, text: str) -> ProgramView:
    chosen = _steps(answer, text)
    row = answer.rows[chosen]
    return ProgramView(
        answer=answer,
        chosen=chosen,
        energy=_energy(answer),
        day=_day(answer, row),
        times=tuple(
            (_clock(start), angle(before), angle(after))
            for start, before, after in zip(row.starts_h, row.angles_deg, row.angles_deg[1:], strict=False)
        ),
    )


def _energy(answer: ProgramAnswer) -> Plot:
    shown = answer.rows[1:]
    counts = [float(row.steps) for row in shown]
    curves: list[Curve] = [
        (N_("electric energy"), counts, [row.electric_wh for row in shown]),
        (N_("net of drive energy"), counts, [row.net_wh for row in shown]),
        (N_("continuous within the range"), [counts[0], counts[-1]], [answer.continuous_wh] * 2),
    ]
    least = min(row.net_wh for row in shown)
    marks = counts if len(counts) > 1 else [counts[0], counts[0] + 1]
    most = max(answer.continuous_wh, *(row.electric_wh for row in shown))
    return line_plot(
        N_("Energy of the day"), N_("number of steps"), "Wh", marks, curves, low=least - 0.05 * (most - least)
    )


def _day(answer: ProgramAnswer, row: ProgramRow) -> Plot:
    """Return the hour angles of panel and sun over solar time, and the beam on an axis of its own."""
    hours, angles = [answer.start_h], [row.angles_deg[0]]
    step_h = answer.question.step_s / 3600.0
    for start, before, after in zip(row.starts_h, row.angles_deg, row.angles_deg[1:], strict=False):
        hours += [start, start + step_h]
        angles += [before, after]
    ends = (answer.start_h, answer.end_h)
    curves: list[Curve] = [
        (Word("panel"), [*hours, answer.end_h], [*angles, row.angles_deg[-1]]),
        (Word("sun"), ends, [DEGREES_AN_HOUR * (NOON_H - at) for at in ends]),
    ]
    beam: Curve = (N_("beam, right axis"), answer.hours, answer.beam_wm2)
    marks = [float(hour) for hour in range(int(min(ends[0], 6)), int(max(ends[1], 18)) + 2)]
    return line_plot(
        N_("Hour angle of panel and sun, and the beam"),
        N_("solar time, hours"),
        N_("degrees, morning positive"),
        marks,
        curves,
        steps=angle_step,
        right=(N_("beam, W/m²"), [beam]),
    )


def _clock(hours: float) -> str:
    minutes = round(hours * 60 * 60)
    return f"{minutes // 3600:02}:{minutes // 60 % 60:02}:{minutes % 60:02}"
