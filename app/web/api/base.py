"""What all API schemas and routes share."""

from enum import Enum
from typing import Annotated, Any, Self

from fastapi import APIRouter, Path, Query
from fastapi.routing import APIRoute
from pydantic import BaseModel, ConfigDict, Field, ModelWrapValidatorHandler, model_validator

from app.instants import Instant
from app.tracker.reason import Reason
from app.web.api.numbers import true_to_kind
from app.web.late_routes import LateRoute

ROOT = "/api/v1"
Responses = dict[int | str, dict[str, Any]]
TrackerId = Annotated[
    str, Path(min_length=1, max_length=64, description="Id of the tracker.", examples=["T1"])
]
RecordingId = Annotated[str, Path(min_length=1, max_length=64, description="Id of the recording.")]
IssuedAt = Annotated[
    Instant | None,
    Query(description="When this was asked, by the site's clock; refused when more than 2 s old or ahead."),
]
Azimuth = Annotated[float, Field(ge=0, lt=360, description="Degrees clockwise from true north.")]
Elevation = Annotated[float, Field(ge=-90, le=90, description="Degrees above the horizon.")]


class Input(BaseModel):
    """What comes in: nothing unknown, no NaN, no infinity, and no text or truth value for a number."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    @model_validator(mode="wrap")
    @classmethod
    def _true_to_kind(cls, given: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        return true_to_kind(given, handler)


class Output(BaseModel):
    """What goes out.

    It is built when it is first used by itself, within a millisecond: its routes hold what
    checks and writes it already, and a second copy of each took more than 1 MB.
    """

    model_config = ConfigDict(frozen=True, defer_build=True)


class Fault(Output):
    """One wrong value of a request."""

    location: str = Field(description="Where the value stands, for example `body.latitude_deg`.")
    message: str = Field(description="What is wrong with it.")


class ProblemDetails(Output):
    """An error as RFC 9457 has it."""

    type: str = Field(description="Kind of problem; `about:blank` says that the status tells all.")
    title: str = Field(description="The status in words.")
    status: int = Field(description="The HTTP status.")
    detail: str = Field(description="A sentence that says what happened and what to do.")
    reasons: tuple[Reason, ...] = Field((), description="Every unmet condition, each with what to do.")
    errors: tuple[Fault, ...] = Field((), description="Every wrong value, with status 422.")


def _problem(description: str) -> dict[str, Any]:
    schema = {"$ref": "#/components/schemas/ProblemDetails"}
    return {"description": description, "content": {"application/problem+json": {"schema": schema}}}


NOT_FOUND: Responses = {404: _problem("There is no such thing.")}
REFUSED: Responses = {
    409: _problem("The state forbids it; `reasons` has every unmet condition."),
    423: _problem("Somebody else has control, or had it since; `reasons` says who, and how to ask."),
}
TOO_MANY: Responses = {429: _problem("Too much of this is under way; try again later.")}
COMMON: Responses = {
    400: _problem("The body cannot be read as text."),
    401: _problem("Nobody has signed in, or the token is unknown, revoked or has expired."),
    413: _problem("The body is larger than one megabyte."),
    403: _problem("Who asks may not do this, or asks from a foreign page or for a foreign host name."),
    422: _problem("Values are missing or wrong."),
    500: _problem("The panel made a mistake."),
    503: _problem("The machine, its drive or the database cannot be reached; nothing was done."),
}


def api_router(*, tags: list[str | Enum], prefix: str = "") -> APIRouter:
    """Return a router below /api/v1, with the errors that every call may answer.

    Both stand in it from its making: FastAPI works a route out once more where a router includes its own,
    and for all of the API that took a third of the panel's start.
    """
    return APIRouter(
        prefix=f"{ROOT}{prefix}",
        tags=tags,
        responses=COMMON,
        route_class=LateRoute,
        generate_unique_id_function=operation_id,
    )


def operation_id(route: APIRoute) -> str:
    """Return what a call is named in the document, and so in clients that are made from it."""
    return route.name
