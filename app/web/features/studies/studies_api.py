"""What tracking is worth: energy of modes and strategies over days or a year, and the best step programs."""

from dataclasses import replace
from enum import StrEnum
from typing import Annotated

from fastapi import File, Path, Query, UploadFile
from fastapi.responses import Response, StreamingResponse
from pydantic import Field
from starlette.concurrency import run_in_threadpool

from app.base.message import N_, told_by
from app.base.permission import Permission
from app.fast.comparison import Comparison
from app.link.messages import ConfigureTracker
from app.studies.folder import LONGEST_FILE_NAME, StudyState, WeatherFile
from app.studies.jobs import ProgramAnswer
from app.studies.request import FIRST_YEAR, LAST_YEAR, StudyRequest
from app.studies.result import StudyResult, curves_csv, table_csv
from app.tracker.settings.stepped import StepProgram
from app.tracker.settings.strategy import Stepped
from app.web.api.base import NOT_FOUND, REFUSED, TOO_MANY, Output, Page, Responses, api_router, whole
from app.web.api.orders import SenderDep
from app.web.api.trackers import detail_of
from app.web.features.studies.study_orders import NewProgram, NewStudy, chosen_program, glance_question
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.services.narrowed import sees_study
from app.web.shell.deps import MachineDep, PanelDep, PrincipalDep

router = api_router(tags=["studies"])

StudyId = Annotated[str, Path(min_length=1, max_length=64, description="Id of the study.")]
FileName = Annotated[
    str, Path(min_length=1, max_length=LONGEST_FILE_NAME, description="Name of the weather file.")
]


class StudyFormat(StrEnum):
    """How a study is written."""

    JSON = "json"
    CSV = "csv"
    CURVES_CSV = "curves-csv"


class Study(Output):
    """A study: how far it is, what was asked, and once it is done what was found."""

    state: StudyState
    request: StudyRequest
    result: StudyResult | None


class FoundPrograms(Output):
    """The table of best programs, the chosen one as a tracker takes it, and where it is used now."""

    answer: ProgramAnswer
    program: StepProgram
    used_on: str | None = Field(description="Null where `use_on` was left out.")


FILES: Responses = {
    200: {
        "description": "As JSON, or as a file: the table of cases, or the curves of its days.",
        "content": {"text/csv": {"schema": {"type": "string"}}},
    }
}


@router.post("/studies", status_code=202, summary="Begin a study", responses=TOO_MANY | NOT_FOUND)
@needs(Permission.SIMULATE)
async def start_study(new: NewStudy, panel: PanelDep, machine: MachineDep, response: Response) -> StudyState:
    """Work out what modes and strategies collect; the answer comes at once, the result when it is done."""
    detail = await machine.detail()
    try:
        request = new.request(detail)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    state = await panel.studies.start(request)
    response.headers["Location"] = f"/api/v1/studies/{state.study_id}"
    return state


@router.get("/studies", summary="All studies, newest first")
@needs(Permission.READ)
def list_studies(panel: PanelDep, who: PrincipalDep) -> Page[StudyState]:
    """Return how far each study is."""
    states = panel.studies.states()
    return whole(one for one in states if sees_study(panel.studies, one.study_id, who.trackers))


@router.get("/studies/comparison", summary="Modes and deadbands at a glance", responses=TOO_MANY | REFUSED)
@needs(Permission.READ)
async def compare_studies(
    panel: PanelDep,
    machine: MachineDep,
    year: Annotated[
        int | None,
        Query(ge=FIRST_YEAR, le=LAST_YEAR, description="Left out: this year."),
    ] = None,
) -> Comparison:
    """Return what each mode collects in a clear year at the site, and what each deadband means."""
    detail = await machine.detail()
    if detail.site.location is None:
        raise NotAcceptable(N_("The site has no location yet: set it first."))
    asked_year = panel.site_now().year if year is None else year
    return await panel.studies.compare(glance_question(detail, detail.site.location, asked_year))


@router.get(
    "/studies/{study_id}", summary="Progress and result", responses=NOT_FOUND | FILES, response_model=Study
)
@needs(Permission.READ)
def read_study(
    study_id: StudyId,
    panel: PanelDep,
    file_format: Annotated[StudyFormat, Query(alias="format")] = StudyFormat.JSON,
) -> Study | Response:
    """Return one study; as CSV only once it is done."""
    folder, state = panel.studies.folder, panel.studies.state(study_id)
    if file_format is StudyFormat.CSV:
        return Response(table_csv(folder.result(study_id)), media_type="text/csv")
    if file_format is StudyFormat.CURVES_CSV:
        return StreamingResponse(curves_csv(folder.result(study_id)), media_type="text/csv")
    result = folder.result(study_id) if state.status == "done" else None
    return Study(state=state, request=folder.request(study_id), result=result)


@router.delete(
    "/studies/{study_id}",
    summary="Cancel or delete",
    responses=NOT_FOUND | {204: {"description": "It had ended and is deleted."}},
    response_model=StudyState,
)
@needs(Permission.SIMULATE)
async def remove_study(study_id: StudyId, panel: PanelDep) -> StudyState | Response:
    """Cancel a study that is under way and answer with it, or delete one that has ended."""
    state = await panel.studies.remove(study_id)
    return Response(status_code=204) if state is None else state


@router.post(
    "/studies/programs", summary="Find the best step programs", responses=TOO_MANY | NOT_FOUND | REFUSED
)
@needs(Permission.SIMULATE)
async def find_best_programs(
    new: NewProgram, panel: PanelDep, machine: MachineDep, sender: SenderDep
) -> FoundPrograms:
    """Return the best program of every number of steps, and have a tracker run one where that is asked."""
    detail = await machine.detail()
    try:
        answer = await panel.studies.find_programs(new.question(detail))
        program = chosen_program(answer, new.steps)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    if new.use_on is not None:
        config = (await detail_of(machine, new.use_on)).state.config
        await sender.send(ConfigureTracker(replace(config, strategy=Stepped(program))))
    return FoundPrograms(answer=answer, program=program, used_on=new.use_on)


@router.get("/weather-files", summary="Weather files that studies can use")
@needs(Permission.READ)
def list_weather_files(panel: PanelDep) -> Page[WeatherFile]:
    """Return the uploaded weather files by name."""
    return whole(panel.studies.folder.weather_files())


@router.post("/weather-files", status_code=201, summary="Upload a weather file", responses=TOO_MANY)
@needs(Permission.SIMULATE)
async def upload_weather_file(
    file: Annotated[UploadFile, File(description="TMY3, EPW or PVGIS CSV, at most 8 MB.")],
    panel: PanelDep,
) -> WeatherFile:
    """Keep a weather file if it can be used; the answer says what it is and where it is from."""
    try:
        return await panel.studies.add_weather(file.filename or "", await file.read())
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error


@router.delete("/weather-files/{name}", status_code=204, summary="Delete a weather file", responses=NOT_FOUND)
@needs(Permission.SIMULATE)
async def delete_weather_file(name: FileName, panel: PanelDep) -> None:
    """Remove a weather file; studies that were made with it stay."""
    await run_in_threadpool(panel.studies.folder.delete_weather, name)
