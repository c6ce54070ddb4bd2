"""Every error -> status and problem+json (RFC 9457); the only such place."""

from collections.abc import Callable
from dataclasses import dataclass, field
from http import HTTPStatus
from math import ceil
from typing import Any

import orjson
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from app.access.authenticator import Throttled, TooManyAtOnce, WrongPassword
from app.access.principal import NotAllowed, ProofNeeded, SignInNeeded
from app.access.users import AccessRefused
from app.alarms.lifecycle import UnknownAlarm
from app.extras import ExtraMissing
from app.link.messages import MachineUnreachable, UnknownRecording, UnknownTracker
from app.logs import get_logger
from app.papers.library import UnknownPaper
from app.store.store import StoreFailed
from app.studies.folder import StudyUnknown, WeatherFileRefused
from app.sun.position import InstantRefused
from app.sun.spa import AlgorithmMissing
from app.tracker.commands import CommandRejected
from app.tracker.control import ControlHeld, ControlLost
from app.tracker.reason import Reason
from app.web.build_id import PageOutdated
from app.web.network import NetworkBusy, NotOnTrial
from app.web.network_check import NetworkRefused
from app.web.routes import methods_of
from app.web.security import add_headers

log = get_logger()

UNREACHABLE_CODES = frozenset({"drive_lost", "drive_unreachable", "drive_silent", "not_stored"})
OWN_MISTAKE = "Internal error; see the Heliopanel log for details. The tracker continues as before."
FOR_PROGRAMS = ("/api/", "/health", "/ready", "/metrics", "/stream", "/diagnostics.zip")
RETRY_LATER = {"Retry-After": "1"}
SIGN_IN = {"WWW-Authenticate": "Bearer"}
PROOF = {"Proof-Needed": "1"}
PROVE = "Confirm your password, then repeat the action."


class NotAcceptable(Exception):
    """What was asked is well formed but cannot be; the text says what to change."""


class NotFound(Exception):
    """There is no such thing; the text says what was looked for."""


class Busy(Exception):
    """The panel does as much as it can; the text says when to come back."""


class NotSetUp(Exception):
    """Nobody manages this panel yet; the text says how to begin."""


@dataclass(frozen=True, slots=True)
class Problem:
    """What went wrong, for the person who reads it."""

    status: int
    detail: str
    reasons: tuple[Reason, ...] = ()
    errors: tuple[dict[str, Any], ...] = ()
    headers: dict[str, str] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Return the status in words."""
        return HTTPStatus(self.status).phrase


ErrorPage = Callable[[Request, Problem], Response]


def rejected(error: CommandRejected) -> Problem:
    """Return 409, or 503 where drive or database cannot be reached, with every unmet condition."""
    silent = any(reason.code in UNREACHABLE_CODES for reason in error.reasons)
    return Problem(503 if silent else 409, str(error), error.reasons, headers=RETRY_LATER if silent else {})


def invalid(error: RequestValidationError) -> Problem:
    """Return 422 with the place and the fault of every wrong value."""
    found = tuple(
        {
            "location": ".".join(str(part) for part in one["loc"]),
            "message": one["msg"].removeprefix("Value error, "),
        }
        for one in error.errors()
    )
    return Problem(422, "Some values are missing or wrong; see errors.", errors=found)


REFUSALS = {
    404: "No page exists at this address. Check the address, or start from the overview of all trackers.",
    405: "This address does not support this method; the Allow header lists the supported methods.",
}


def refused_by_http(error: HTTPException) -> Problem:
    """Return what the framework refused, such as 404 and 405, with a sentence that says what to do."""
    detail = REFUSALS.get(error.status_code, error.detail) if error.detail == _phrase(error) else error.detail
    return Problem(error.status_code, detail, headers=dict(error.headers or {}))


def _phrase(error: HTTPException) -> str:
    return HTTPStatus(error.status_code).phrase


def _unreachable(error: Exception) -> Problem:
    text = str(error) or "The controller service does not answer; nothing was done. Try again in a moment."
    return Problem(503, text, headers=RETRY_LATER)


def _wait(error: Throttled) -> dict[str, str]:
    return {"Retry-After": str(ceil(error.wait.total_seconds()))}


def _wrong_fields(error: NetworkRefused) -> Problem:
    found = tuple({"location": f"body.{name}", "message": text} for name, text in error.errors.items())
    return Problem(422, str(error), errors=found)


def _no_tracker(error: Exception) -> Problem:
    return Problem(404, _sentence(error, f"There is no tracker {error}."))


def _no_recording(error: Exception) -> Problem:
    return Problem(404, _sentence(error, f"There is no recording {error}."))


def _sentence(error: Exception, otherwise: str) -> str:
    return str(error) if str(error).endswith(".") else otherwise


PROBLEMS: dict[type[Exception], Callable[[Any], Problem]] = {
    CommandRejected: rejected,
    ControlHeld: lambda error: Problem(423, str(error), error.reasons),
    ControlLost: lambda error: Problem(423, str(error), error.reasons),
    SignInNeeded: lambda error: Problem(401, str(error), headers=SIGN_IN),
    ProofNeeded: lambda error: Problem(
        403, str(error), (Reason("proof_needed", str(error), PROVE),), headers=PROOF
    ),
    NotAllowed: lambda error: Problem(403, str(error)),
    WrongPassword: lambda error: Problem(401, str(error), headers=SIGN_IN),
    Throttled: lambda error: Problem(429, str(error), headers=_wait(error)),
    TooManyAtOnce: lambda error: Problem(429, str(error), headers=RETRY_LATER),
    AccessRefused: lambda error: Problem(422, str(error)),
    UnknownTracker: _no_tracker,
    UnknownRecording: _no_recording,
    UnknownAlarm: lambda error: Problem(404, str(error)),
    MachineUnreachable: _unreachable,
    ExtraMissing: lambda error: Problem(501, str(error)),
    StoreFailed: lambda error: Problem(503, str(error), headers=RETRY_LATER),
    InstantRefused: lambda error: Problem(422, str(error)),
    UnknownPaper: lambda error: Problem(404, str(error)),
    AlgorithmMissing: lambda error: Problem(422, str(error)),
    NotAcceptable: lambda error: Problem(422, str(error)),
    PageOutdated: lambda error: Problem(409, str(error), headers={"Page-Outdated": "1"}),
    NetworkRefused: _wrong_fields,
    NetworkBusy: lambda error: Problem(409, str(error)),
    NotOnTrial: lambda error: Problem(409, str(error)),
    Busy: lambda error: Problem(429, str(error), headers={"Retry-After": "5"}),
    StudyUnknown: lambda error: Problem(404, str(error)),
    WeatherFileRefused: lambda error: Problem(422, str(error)),
    NotSetUp: lambda error: Problem(503, str(error)),
    NotFound: lambda error: Problem(404, str(error)),
    RequestValidationError: invalid,
    HTTPException: refused_by_http,
    Exception: lambda _: Problem(
        500,
        "Internal error; see the Heliopanel log for details. Motion is not affected.",
        headers={"Connection": "close"},
    ),
}


def machine_problem(error: Exception) -> Problem:
    """Return what to tell about an error of the machine; what it calls impossible is a 422."""
    return problem_of(NotAcceptable(str(error)) if isinstance(error, ValueError) else error)


def problem_of(error: Exception) -> Problem:
    """Return what to tell about an error."""
    for kind in type(error).__mro__:
        if kind in PROBLEMS:
            return PROBLEMS[kind](error)
    raise error


def problem_response(problem: Problem) -> Response:
    """Return a problem as application/problem+json."""
    body: dict[str, Any] = {
        "type": "about:blank",
        "title": problem.title,
        "status": problem.status,
        "detail": problem.detail.encode(errors="replace").decode(),
    }
    if problem.reasons:
        body["reasons"] = problem.reasons
    if problem.errors:
        body["errors"] = problem.errors
    return Response(orjson.dumps(body), problem.status, problem.headers, "application/problem+json")


def _respond(request: Request, problem: Problem) -> Response:
    error_page: ErrorPage | None = getattr(request.app.state, "error_page", None)
    if error_page is None or request.url.path.startswith(FOR_PROGRAMS):
        return problem_response(problem)
    return error_page(request, problem)


def answer_to(request: Request, error: Exception) -> Response:
    """Return the answer that tells about an error, in the form that the address asks for."""
    problem = problem_of(error)
    if problem.status >= 500:
        log.error("request failed", path=request.url.path, status=problem.status, error=repr(error))
    response = _respond(request, problem)
    add_headers(response.headers)
    return response


def install(app: FastAPI) -> None:
    """Answer every error with problem+json, on pages with `app.state.error_page` where that is set."""

    async def answer(request: Request, error: Exception) -> Response:
        response = answer_to(request, error)
        if response.status_code == HTTPStatus.METHOD_NOT_ALLOWED:
            response.headers["Allow"] = ", ".join(methods_of(app.state.routes, request.url.path))
        return response

    for kind in PROBLEMS:
        app.add_exception_handler(kind, answer)
