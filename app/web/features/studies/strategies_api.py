"""Strategies: the step program of a tracker as JSON and CSV, and a day by any strategy."""

from dataclasses import replace
from enum import StrEnum
from typing import Annotated

from fastapi import Body
from fastapi.responses import PlainTextResponse, Response
from pydantic import Field, WrapValidator
from starlette.requests import Request

from app.base.adapter import adapter
from app.base.file_text import TextRefused, text_of
from app.base.instants import Day
from app.base.message import N_, told_by
from app.base.permission import Permission
from app.base.zones import day_in
from app.link.messages import ConfigureTracker
from app.show.strategy_told import StrategyDay
from app.tracker.programs.examples import EXAMPLES
from app.tracker.programs.step_table import TableWrong, from_table, to_table
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped, Strategy
from app.web.api.base import (
    CHANGED,
    NOT_FOUND,
    REFUSED,
    TAGGED,
    TOO_MANY,
    Input,
    Responses,
    TrackerId,
    api_router,
)
from app.web.api.numbers import true_to_kind
from app.web.api.orders import SenderDep
from app.web.api.sun import location_of, midnights
from app.web.api.tags import tag_of, unless_changed
from app.web.api.trackers import detail_of
from app.web.features.studies.strategies import asked_day, day_of, kept_program
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, PanelDep, SnapshotDep

router = api_router(prefix="/trackers/{tracker_id}", tags=["trackers"])

CSV = "text/csv; charset=utf-8"
TABLE: Responses = {200: TAGGED[200] | {"content": {"text/csv": {"schema": {"type": "string"}}}}}
CSV_BODY = {
    "requestBody": {
        "description": "The table in UTF-8, or in UTF-16 with a byte order mark; `text/csv` is taken as "
        "well, but few client generators know it.",
        "required": True,
        "content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}},
    }
}


class ProgramFormat(StrEnum):
    """How a step program is written."""

    JSON = "json"
    CSV = "csv"


class StrategyQuestion(Input):
    """Which day by which strategy."""

    strategy: Annotated[Strategy, Field(discriminator="kind")] | None = Field(
        None, description="Left out: the tracker's own."
    )
    date: Day | None = Field(None, description="Civil date of the site; left out: today.")


async def strategy_of(machine: MachineDep, tracker_id: TrackerId) -> Strategy:
    """Return how a tracker tracks, its step program with it."""
    return (await detail_of(machine, tracker_id)).state.config.strategy


@router.get(
    "/program",
    summary="The step program that a tracker follows",
    response_model=StepProgram,
    responses=TABLE | NOT_FOUND,
)
@needs(Permission.READ)
async def read_program(
    tracker_id: TrackerId, machine: MachineDep, format: ProgramFormat = ProgramFormat.JSON
) -> Response:
    """Return the program as JSON, or as CSV that the same path takes."""
    tracker = await detail_of(machine, tracker_id)
    program, tag = kept_program(tracker), {"ETag": tag_of(tracker.state.config.strategy)}
    if format is ProgramFormat.CSV:
        return PlainTextResponse(to_table(program), headers=tag, media_type=CSV)
    return Response(adapter(StepProgram).dump_json(program), headers=tag, media_type="application/json")


@router.put(
    "/program",
    summary="Have a tracker follow a step program",
    responses=CHANGED | NOT_FOUND | REFUSED,
    dependencies=[unless_changed(strategy_of)],
)
@needs(Permission.CONFIGURE)
async def write_program(
    tracker_id: TrackerId,
    program: Annotated[StepProgram, Body(), WrapValidator(true_to_kind)],
    sender: SenderDep,
    machine: MachineDep,
) -> StepProgram:
    """Keep the program and make it the tracker's strategy; refused while the tracker moves."""
    return await _follow(tracker_id, program, sender, machine)


@router.put(
    "/program.csv",
    summary="Have a tracker follow a step program in CSV",
    responses=CHANGED | NOT_FOUND | REFUSED,
    openapi_extra=CSV_BODY,
    dependencies=[unless_changed(strategy_of)],
)
@needs(Permission.CONFIGURE)
async def write_program_table(
    tracker_id: TrackerId, request: Request, sender: SenderDep, machine: MachineDep
) -> StepProgram:
    """Read the table, keep the program and make it the tracker's strategy."""
    try:
        program = from_table(text_of(await request.body()))
    except TextRefused as error:
        raise NotAcceptable(N_("The file is not UTF-8 text; save it as CSV in UTF-8.")) from error
    except TableWrong as error:
        raise NotAcceptable(told_by(error)) from error
    return await _follow(tracker_id, program, sender, machine)


@router.get("/program/examples", summary="Step programs that come with Heliopanel", responses=NOT_FOUND)
@needs(Permission.READ)
async def read_examples(tracker_id: TrackerId, machine: MachineDep) -> dict[str, StepProgram]:
    """Return each example by its short name."""
    await detail_of(machine, tracker_id)
    return EXAMPLES


@router.post("/strategy/day", summary="A day by a strategy", responses=NOT_FOUND | TOO_MANY, status_code=200)
@needs(Permission.READ)
async def plan_strategy_day(
    tracker_id: TrackerId,
    question: StrategyQuestion,
    panel: PanelDep,
    site: SnapshotDep,
    machine: MachineDep,
) -> StrategyDay:
    """Simulate the day with the real controller, and return moves, errors, travel and curves."""
    tracker = await detail_of(machine, tracker_id)
    begin, end = midnights(question.date or day_in(site.time_zone, site.at), site.time_zone)
    strategy = question.strategy or tracker.state.config.strategy
    asked = asked_day(tracker, strategy, location_of(site), begin, end)
    try:
        return await panel.simulations.work_out(day_of, asked)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error


async def _follow(
    tracker_id: str, program: StepProgram, sender: SenderDep, machine: MachineDep
) -> StepProgram:
    config = (await detail_of(machine, tracker_id)).state.config
    await sender.send(ConfigureTracker(replace(config, strategy=Stepped(program))))
    return kept_program(await detail_of(machine, tracker_id))
