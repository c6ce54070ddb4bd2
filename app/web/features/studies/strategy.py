"""The strategy page: when the tracker moves, its step program, and the correction by light sensors."""

from dataclasses import replace
from datetime import datetime, time, timedelta
from typing import Annotated

from fastapi import Form
from fastapi.responses import PlainTextResponse
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, NOTHING, Message, Word, join, say, told_by, with_format
from app.base.permission import Permission
from app.base.zones import day_in, zone_of
from app.link.messages import ConfigureTracker, TrackerDetail
from app.show.strategy_told import StrategyDay
from app.tracker.programs.examples import EXAMPLES
from app.tracker.programs.step_table import TableWrong, from_table, to_table
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Deadband, HybridConfig, Stepped
from app.web.charts.axis import DAY_HOURS, angle_step
from app.web.charts.plot import Plot, line_plot
from app.web.features.studies.strategies import asked_day, day_of, kept_program
from app.web.features.studies.strategy_contexts import ProgramTable, StrategyDayPart, StrategyPage
from app.web.features.studies.strategy_forms import (
    AIMS,
    BASES,
    CHOICES,
    FRAMES,
    LABELS,
    HybridForm,
    ProgramForm,
    StrategyForm,
    hybrid_texts,
    read_hybrid,
    read_program,
    read_strategy,
    shown_program,
    strategy_texts,
    typed_program,
)
from app.web.http.attachments import BYTE_ORDER_MARK, kept_as
from app.web.http.errors import NotAcceptable
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import MachineDep, PanelDep
from app.web.shell.formats import angle
from app.web.shell.forms import Typed
from app.web.shell.frame import tracker_frame
from app.web.shell.orders import PressDep
from app.web.shell.render import go, page
from app.web.shell.wizard import tracker_of

router = page_router(prefix="/trackers/{tracker_id}/strategy")
SAVED = N_("The strategy is saved.")


@router.get("")
@needs(Permission.READ)
async def strategy(request: Request, tracker_id: str, machine: MachineDep, done: str = "") -> Response:
    """Show strategy, program and correction as they are stored."""
    return _answer(request, tracker_of(await machine.detail(), tracker_id), done=bool(done))


@router.post("")
@needs(Permission.CONFIGURE)
async def save(
    tracker_id: str, press: PressDep, machine: MachineDep, form: Annotated[StrategyForm, Form()]
) -> Response:
    """Save strategy and deadband, or nothing."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = Typed(form.model_dump())
    config = tracker.state.config
    wanted = read_strategy(typed, config.strategy)
    deadband_deg = config.deadband_deg
    if isinstance(wanted, Deadband):
        deadband_deg = typed.number("deadband", N_("Deadband"), 0.02, 10, "°")
    if typed.errors:
        return _answer(press.request, tracker, typed=typed, block="choice", status=422)
    try:
        await press.send(ConfigureTracker(replace(config, strategy=wanted, deadband_deg=deadband_deg)))
    except NotAcceptable as refusal:
        typed.errors["kind"] = told_by(refusal)
        return _answer(press.request, tracker, typed=typed, block="choice", status=422)
    return press.answer(SAVED)


@router.get("/day")
@needs(Permission.READ)
async def day(
    request: Request,
    tracker_id: str,
    machine: MachineDep,
    built: PanelDep,
) -> Response:
    """Draw today by the strategy that is typed, simulated with the real controller."""
    detail = await machine.detail()
    tracker = tracker_of(detail, tracker_id)
    asked = StrategyForm.model_validate(strategy_texts(tracker.state.config) | dict(request.query_params))
    typed = Typed(asked.model_dump())
    wanted = read_strategy(typed, tracker.state.config.strategy)
    if detail.site.location is None:
        raise NotAcceptable(N_("Save the location first: step 1 of commissioning."))
    if typed.errors:
        raise NotAcceptable(join(" ", typed.errors.values()))
    begin, end = _today(built.site_now(), detail.site.time_zone)
    question = asked_day(tracker, wanted, detail.site.location, begin, end)
    try:
        found = await built.simulations.work_out(day_of, question)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    return page(request, _day_part(found, LABELS[wanted.kind], _played(tracker.state.config.hybrid)))


@router.post("/program")
@needs(Permission.CONFIGURE)
async def program(
    tracker_id: str, press: PressDep, machine: MachineDep, form: Annotated[ProgramForm, Form()]
) -> Response:
    """Save the table as the tracker's program; or fill it from a table, an example, or with more rows."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    try:
        filled = _filled(form)
        if filled is not None:
            return _answer(press.request, tracker, table=filled, block="program")
        wanted = read_program(form)
    except TableWrong as error:
        table = typed_program(form, error.sentences, more=0)
        return _answer(press.request, tracker, table=table, block="program", status=422)
    try:
        await press.send(ConfigureTracker(replace(tracker.state.config, strategy=Stepped(wanted))))
    except NotAcceptable as refusal:
        table = typed_program(form, (told_by(refusal),), more=0)
        return _answer(press.request, tracker, table=table, block="program", status=422)
    return go(press.request, f"/trackers/{tracker_id}/strategy?done=program")


@router.get("/program.csv")
@needs(Permission.READ)
async def export(tracker_id: str, machine: MachineDep) -> Response:
    """Hand the kept program out as a table."""
    kept = kept_program(tracker_of(await machine.detail(), tracker_id))
    named = kept_as(f"{tracker_id}-program.csv")
    return PlainTextResponse(
        BYTE_ORDER_MARK + to_table(kept), headers=named, media_type="text/csv; charset=utf-8"
    )


@router.post("/hybrid")
@needs(Permission.CONFIGURE)
async def hybrid(
    tracker_id: str, press: PressDep, machine: MachineDep, form: Annotated[HybridForm, Form()]
) -> Response:
    """Save the correction by light sensors, or nothing."""
    tracker = tracker_of(await machine.detail(), tracker_id)
    typed = Typed(form.model_dump())
    wanted = read_hybrid(typed)
    if wanted is None:
        return _answer(press.request, tracker, hybrid=typed, block="hybrid", status=422)
    try:
        await press.send(ConfigureTracker(replace(tracker.state.config, hybrid=wanted)))
    except NotAcceptable as refusal:
        typed.errors["enabled"] = told_by(refusal)
        return _answer(press.request, tracker, hybrid=typed, block="hybrid", status=422)
    return press.answer(N_("The correction is saved."))


def _filled(form: ProgramForm) -> ProgramTable | None:
    """Return the table filled as a key asks for it; None if it is to be saved. Raises `TableWrong`."""
    match form.do:
        case "rows":
            return typed_program(form)
        case "import":
            return shown_program(
                from_table(form.table), note=N_("Imported. Check the program, then save it.")
            )
        case "example" if form.example in EXAMPLES:
            return shown_program(EXAMPLES[form.example], note=N_("Check the example, then save it."))
        case _:
            return None


def _answer(
    request: Request,
    tracker: TrackerDetail,
    *,
    typed: Typed | None = None,
    table: ProgramTable | None = None,
    hybrid: Typed | None = None,
    block: str | None = None,
    status: int = 200,
    done: bool = False,
) -> Response:
    config = tracker.state.config
    kept: StepProgram | None = config.strategy.program if isinstance(config.strategy, Stepped) else None
    root = f"/trackers/{config.tracker_id}"
    shown = typed or Typed(strategy_texts(config))
    light = hybrid or Typed(hybrid_texts(config.hybrid))
    context = StrategyPage(
        frame=tracker_frame(
            request, config.tracker_id, N_("Strategy"), back=Link(N_("Settings"), f"{root}/settings")
        ),
        form=shown.form(StrategyForm.model_fields),
        choices=CHOICES,
        program=table or shown_program(kept),
        hybrid=light.form(HybridForm.model_fields),
        keeps_program=kept is not None,
        done=say("{name} is saved; the tracker now uses it.", name=kept.name) if done and kept else "",
        aims=AIMS,
        bases=BASES,
        frames=FRAMES,
        examples=tuple((name, one.name) for name, one in EXAMPLES.items()),
    )
    return page(request, context, block=block, status=status)


def _today(at: datetime, zone: str) -> tuple[datetime, datetime]:
    begin = datetime.combine(day_in(zone, at), time(), zone_of(zone))
    return begin, begin + timedelta(days=1)


def _played(hybrid: HybridConfig) -> Message:
    """Return by which light sensors the day was corrected, nothing where it was not."""
    if not hybrid.enabled:
        return NOTHING
    light = hybrid.simulated
    azimuth, elevation = angle(light.azimuth_deg), angle(light.elevation_deg)
    if light.cloud:
        return say(
            "Corrected by simulated light sensors: panel misaligned by {azimuth} and "
            "{elevation}, cloud blocking {cloud} % of the direct irradiance. Errors and curves "
            "show where the panel really faces.",
            azimuth=azimuth,
            elevation=elevation,
            cloud=with_format(light.cloud * 100.0, ".0f"),
        )
    return say(
        "Corrected by simulated light sensors: panel misaligned by {azimuth} and "
        "{elevation}. Errors and curves show where the panel really faces.",
        azimuth=azimuth,
        elevation=elevation,
    )


def _day_part(found: StrategyDay, label: str, played: str) -> StrategyDayPart:
    return StrategyDayPart(
        label=label,
        played=played,
        day=found,
        azimuth=_plot(N_("Azimuth today"), found, found.panel_azimuth_deg, found.sun_azimuth_deg),
        elevation=_plot(N_("Elevation today"), found, found.panel_elevation_deg, found.sun_elevation_deg),
    )


def _plot(title: str, found: StrategyDay, panel: tuple[float, ...], sun: tuple[float, ...]) -> Plot:
    """Return panel and sun over the hours of the day; the sun only while it is up."""
    hours = [seconds / 3600.0 for seconds in found.elapsed_s]
    lit = [place for place, height in enumerate(found.sun_elevation_deg) if height > 0.0]
    sun_curve = (Word("sun"), [hours[i] for i in lit], [sun[i] for i in lit])
    curves = [(Word("panel"), hours, panel), sun_curve]
    return line_plot(title, N_("hour of the day at the site"), "degrees", DAY_HOURS, curves, steps=angle_step)
