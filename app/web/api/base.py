"""What all API schemas and routes share."""

from collections.abc import Iterable, Sequence
from enum import Enum
from typing import Annotated, Any, Generic, Self, TypeVar

from fastapi import APIRouter, Path, Query
from fastapi.routing import APIRoute
from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ModelWrapValidatorHandler, model_validator

from app.base.instants import Instant
from app.base.names import clean
from app.link.order_models import Azimuth as Azimuth
from app.link.order_models import Elevation as Elevation
from app.tracker.values.reason import Reason
from app.web.api.numbers import true_to_kind
from app.web.http.late_routes import LateRoute
from app.web.http.problems import MEDIA_TYPE, Fault, ProblemCode

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


def _clean(given: Any) -> Any:
    return clean(given) if isinstance(given, str) else given


def _clean_lines(given: Any) -> Any:
    return clean(given, lines=True) if isinstance(given, str) else given


Clean = BeforeValidator(_clean)
"""A name or a short text as it is stored; its length is that of what is stored."""
CleanLines = BeforeValidator(_clean_lines)


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


T = TypeVar("T")


class Page(Output, Generic[T]):
    """A list, and where it continues."""

    items: tuple[T, ...] = Field(description="What the list has here.")
    next: str | None = Field(None, description="`cursor` of the next page; null: there is no more.")

    @classmethod
    def model_parametrized_name(cls, params: tuple[Any, ...]) -> str:
        """Return what the document and clients call a list of these."""
        return f"{params[0].__name__}Page"


def whole(items: Iterable[T]) -> Page[T]:
    """Return a list that is one page."""
    return Page[T](items=tuple(items))


CURSOR = "`next` of the page before; left out: the first page."
Cursor = Annotated[str | None, Query(pattern=r"^[1-9][0-9]{0,17}$", description=CURSOR)]
Limit = Annotated[int, Query(ge=1, le=1000, description="At most so many items.")]


def before(cursor: str | None) -> int | None:
    """Return the number that a page of numbered items is to end before."""
    return None if cursor is None else int(cursor)


def following(numbers: Sequence[int], limit: int) -> str | None:
    """Return the cursor of the page after one with these numbers, None where there can be no more."""
    return str(numbers[-1]) if len(numbers) == limit else None


class ProblemDetails(Output):
    """An error as RFC 9457 has it."""

    type: str = Field(description="URI of the kind of problem: where the manual of this installation is.")
    code: ProblemCode = Field(description="The kind of problem, for programs.")
    title: str = Field(description="The status in words.")
    status: int = Field(description="The HTTP status.")
    detail: str = Field(description="A sentence that says what happened and what to do.")
    reasons: tuple[Reason, ...] = Field((), description="Every unmet condition, each with what to do.")
    errors: tuple[Fault, ...] = Field((), description="Every wrong value, with `invalid_values`.")


def problem(description: str) -> dict[str, Any]:
    """Return what the document says of an answer that is a problem."""
    schema = {"$ref": "#/components/schemas/ProblemDetails"}
    return {"description": description, "content": {MEDIA_TYPE: {"schema": schema}}}


NOT_FOUND: Responses = {404: problem("There is no such thing.")}
REFUSED: Responses = {
    409: problem("The state forbids it; `reasons` has every unmet condition."),
    423: problem("Somebody else has control, or had it since; `reasons` says who, and how to ask."),
}
CHANGED: Responses = {412: problem("The settings have changed since `If-Match` was read.")}
TAGGED: Responses = {
    200: {
        "headers": {
            "ETag": {"description": "These settings; send it as `If-Match`.", "schema": {"type": "string"}}
        }
    }
}
TOO_MANY: Responses = {429: problem("Too much of this is under way; try again later.")}
COMMON: Responses = {
    400: problem("The body cannot be read as text."),
    401: problem("Nobody has signed in, or the token is unknown, revoked or has expired."),
    413: problem("The body is larger than one megabyte."),
    403: problem("Who asks may not do this, or asks from a foreign page or for a foreign host name."),
    422: problem("Values are missing or wrong."),
    500: problem("The panel made a mistake."),
    503: problem("The machine, its drive or the database cannot be reached; nothing was done."),
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
