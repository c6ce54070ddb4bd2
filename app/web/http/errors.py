"""Every error -> status and problem+json (RFC 9457); the only such place."""

from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from math import ceil
from typing import Any
from urllib.parse import quote

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from starlette.exceptions import HTTPException
from starlette.responses import Response

from app.access.principal import NotAllowed, ProofNeeded, SignInNeeded
from app.access.sign_in_errors import Throttled, TooManyAtOnce, WrongPassword
from app.access.users import AccessRefused
from app.alarms.lifecycle import UnknownAlarm
from app.base.extras import ExtraMissing
from app.base.logs import get_logger
from app.base.message import N_, Message, plain, say, told_by, told_of_value
from app.link.messages import MachineUnreachable, UnknownRecording, UnknownTracker
from app.research.library import UnknownPaper
from app.store.store import StoreFailed
from app.studies.folder import StudyUnknown, WeatherFileRefused
from app.sun.position import InstantRefused
from app.sun.spa import AlgorithmMissing
from app.tracker.commands.commands import CommandRejected
from app.tracker.commands.control import ControlHeld, ControlLost
from app.tracker.values.reason import Reason
from app.web.http.build_id import PageOutdated
from app.web.http.network import NetworkBusy, NotOnTrial
from app.web.http.network_check import NetworkRefused
from app.web.http.problems import MEDIA_TYPE, Fault, Problem, ProblemCode, SettingsChanged, code_of_status
from app.web.http.routes import methods_of
from app.web.http.security import add_headers
from app.web.http.whole_forms import FormIncomplete

log = get_logger()

UNREACHABLE_CODES = frozenset({"drive_lost", "drive_unreachable", "drive_silent", "not_stored"})
OWN_MISTAKE = N_("Internal error; see the Heliopanel log for details. The tracker continues as before.")
FOR_PROGRAMS = ("/api/", "/health", "/ready", "/metrics", "/stream", "/diagnostics.zip")
RETRY_LATER = {"Retry-After": "1"}
SIGN_IN = {"WWW-Authenticate": "Bearer"}
PROOF = {"Proof-Needed": "1"}
PROVE = N_("Confirm your password, then repeat the action.")


class NotAcceptable(Exception):
    """What was asked is well formed but cannot be; the text says what to change."""


class NotFound(Exception):
    """There is no such thing; the text says what was looked for."""


class Busy(Exception):
    """The panel does as much as it can; the text says when to come back."""


class NotSetUp(Exception):
    """Nobody manages this panel yet; the text says how to begin."""


ErrorPage = Callable[[Request, Problem], Response]


def rejected(error: CommandRejected) -> Problem:
    """Return 409, or 503 where drive or database cannot be reached, with every unmet condition."""
    silent = any(reason.code in UNREACHABLE_CODES for reason in error.reasons)
    code = ProblemCode.UNREACHABLE if silent else ProblemCode.COMMAND_REJECTED
    return Problem(code, told_by(error), error.reasons, headers=RETRY_LATER if silent else {})


def invalid(error: RequestValidationError) -> Problem:
    """Return 422 with the place and the fault of every wrong value."""
    found = tuple(dict.fromkeys(_fault(one, error.body) for one in error.errors()))
    return Problem(
        ProblemCode.INVALID_VALUES, N_("Some values are missing or wrong; see errors."), errors=found
    )


def _fault(wrong: dict[str, Any], body: Any) -> Fault:
    place, *path = wrong["loc"]
    detail = told_of_value(wrong)
    if place == "body":
        return Fault(detail, pointer=pointer(_in_body(path, body, is_missing=wrong["type"] == "missing")))
    return Fault(detail, parameter=str(path[0]) if path else None)


def _in_body(path: Sequence[str | int], body: Any, *, is_missing: bool) -> list[str | int]:
    """Return the steps into a body, without what only says which of several kinds a value was taken for."""
    steps: list[str | int] = []
    for number, step in enumerate(path, start=1):
        if isinstance(body, Mapping) and (step in body or (is_missing and number == len(path))):
            body = body.get(step)
        elif isinstance(step, int) and isinstance(body, list) and step < len(body):
            body = body[step]
        else:
            continue
        steps.append(step)
    return steps


def pointer(steps: Sequence[str | int]) -> str:
    """Return the JSON Pointer (RFC 6901) to a value of a body, as the fragment of a URI."""
    escaped = (quote(str(step).replace("~", "~0").replace("/", "~1")) for step in steps)
    return "#" + "".join(f"/{step}" for step in escaped)


REFUSALS = {
    404: N_("No page exists at this address. Check the address, or start from the overview of all trackers."),
    405: N_("This address does not support this method; the Allow header lists the supported methods."),
}


def refused_by_http(error: HTTPException) -> Problem:
    """Return what the framework refused, such as 404 and 405, with a sentence that says what to do."""
    detail = REFUSALS.get(error.status_code, error.detail) if error.detail == _phrase(error) else error.detail
    return Problem(code_of_status(error.status_code), plain(detail), headers=dict(error.headers or {}))


def _phrase(error: HTTPException) -> str:
    return HTTPStatus(error.status_code).phrase


def _unreachable(error: Exception) -> Problem:
    text = told_by(error) or N_(
        "The controller service does not answer; nothing was done. Try again in a moment."
    )
    return Problem(ProblemCode.CONTROLLER_UNREACHABLE, text, headers=RETRY_LATER)


def _wait(error: Throttled) -> dict[str, str]:
    return {"Retry-After": str(ceil(error.wait.total_seconds()))}


def _wrong_fields(error: NetworkRefused) -> Problem:
    found = tuple(Fault(text, pointer=pointer([name])) for name, text in error.errors.items())
    return Problem(ProblemCode.INVALID_VALUES, told_by(error), errors=found)


def _no_tracker(error: Exception) -> Problem:
    return Problem(
        ProblemCode.UNKNOWN_TRACKER,
        _sentence(error, say("There is no tracker {error}.", error=told_by(error))),
    )


def _no_recording(error: Exception) -> Problem:
    return Problem(
        ProblemCode.UNKNOWN_RECORDING,
        _sentence(error, say("There is no recording {error}.", error=told_by(error))),
    )


def _sentence(error: Exception, otherwise: Message) -> Message:
    return told_by(error) if told_by(error).endswith(".") else otherwise


def _of(code: ProblemCode, headers: dict[str, str] | None = None) -> Callable[[Exception], Problem]:
    """Return what tells of an error in its own words."""
    return lambda error: Problem(code, told_by(error), headers=headers or {})


PROBLEMS: dict[type[Exception], Callable[[Any], Problem]] = {
    CommandRejected: rejected,
    ControlHeld: lambda error: Problem(ProblemCode.CONTROL_HELD, told_by(error), error.reasons),
    ControlLost: lambda error: Problem(ProblemCode.CONTROL_LOST, told_by(error), error.reasons),
    SignInNeeded: _of(ProblemCode.SIGN_IN_REQUIRED, SIGN_IN),
    ProofNeeded: lambda error: Problem(
        ProblemCode.REAUTHENTICATION_REQUIRED,
        told_by(error),
        (Reason("reauthentication_required", told_by(error), PROVE),),
        headers=PROOF,
    ),
    NotAllowed: _of(ProblemCode.NOT_ALLOWED),
    WrongPassword: _of(ProblemCode.WRONG_CREDENTIALS, SIGN_IN),
    Throttled: lambda error: Problem(ProblemCode.TOO_MANY_ATTEMPTS, told_by(error), headers=_wait(error)),
    TooManyAtOnce: _of(ProblemCode.TOO_MANY_SIGN_INS, RETRY_LATER),
    AccessRefused: _of(ProblemCode.ACCOUNT_REFUSED),
    UnknownTracker: _no_tracker,
    UnknownRecording: _no_recording,
    UnknownAlarm: _of(ProblemCode.UNKNOWN_ALARM),
    MachineUnreachable: _unreachable,
    ExtraMissing: _of(ProblemCode.EXTRA_MISSING),
    StoreFailed: _of(ProblemCode.STORE_FAILED, RETRY_LATER),
    InstantRefused: _of(ProblemCode.INSTANT_REFUSED),
    UnknownPaper: _of(ProblemCode.UNKNOWN_PAPER),
    AlgorithmMissing: _of(ProblemCode.ALGORITHM_MISSING),
    NotAcceptable: _of(ProblemCode.NOT_ACCEPTABLE),
    FormIncomplete: _of(ProblemCode.NOT_ACCEPTABLE),
    SettingsChanged: _of(ProblemCode.PRECONDITION_FAILED),
    PageOutdated: _of(ProblemCode.PAGE_OUTDATED, {"Page-Outdated": "1"}),
    NetworkRefused: _wrong_fields,
    NetworkBusy: _of(ProblemCode.NETWORK_BUSY),
    NotOnTrial: _of(ProblemCode.NOT_ON_TRIAL),
    Busy: _of(ProblemCode.TOO_MANY_REQUESTS, {"Retry-After": "5"}),
    StudyUnknown: _of(ProblemCode.UNKNOWN_STUDY),
    WeatherFileRefused: _of(ProblemCode.WEATHER_FILE_REFUSED),
    NotSetUp: _of(ProblemCode.NOT_SET_UP),
    NotFound: _of(ProblemCode.NOT_FOUND),
    RequestValidationError: invalid,
    HTTPException: refused_by_http,
    Exception: lambda _: Problem(
        ProblemCode.INTERNAL_ERROR,
        N_("Internal error; see the Heliopanel log for details. Motion is not affected."),
        headers={"Connection": "close"},
    ),
}


def machine_problem(error: Exception) -> Problem:
    """Return what to tell about an error of the machine; what it calls impossible is a 422."""
    return problem_of(NotAcceptable(told_by(error)) if isinstance(error, ValueError) else error)


def problem_of(error: Exception) -> Problem:
    """Return what to tell about an error."""
    for kind in type(error).__mro__:
        if kind in PROBLEMS:
            return PROBLEMS[kind](error)
    raise error


def problem_response(problem: Problem) -> Response:
    """Return a problem as application/problem+json."""
    return Response(problem.body(), problem.status, problem.headers, MEDIA_TYPE)


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
