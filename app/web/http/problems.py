"""Every kind of problem that an answer tells of: its code, its status, and when it occurs."""

from dataclasses import dataclass, field
from enum import StrEnum
from http import HTTPStatus
from typing import Annotated, Any

import orjson
from pydantic import Field

from app.base.message import Message
from app.tracker.values.reason import Reason

MEDIA_TYPE = "application/problem+json"
TYPES = "/manual/reference/errors.html"
"""Where the manual of every Heliopanel says what a type means."""


RENAMED = {413: "Request Entity Too Large", 422: "Unprocessable Entity"}
"""What Python calls otherwise from 3.13 on; the catalogues have these."""


def phrase(status: int) -> str:
    """Return a status in the words that every version of Python, and every catalogue, has."""
    return RENAMED.get(status) or HTTPStatus(status).phrase


class ProblemCode(StrEnum):
    """What programs go by: one code for each kind of problem, always with the same status."""

    status: int
    when: str

    def __new__(cls, code: str, status: int, when: str) -> "ProblemCode":
        """Make a code that knows its status and when it occurs."""
        made = str.__new__(cls, code)
        made._value_ = code
        made.status, made.when = status, when
        return made

    @property
    def type(self) -> str:
        """Return the URI of the kind, relative to the address of the installation."""
        return f"{TYPES}#{self.value}"

    UNREADABLE = "unreadable", 400, "The request or its body cannot be read."
    HOST_REFUSED = "host_refused", 400, "The request names no host, or more than one."
    SIGN_IN_REQUIRED = "sign_in_required", 401, "Not signed in, or the session or token has ended."
    WRONG_CREDENTIALS = "wrong_credentials", 401, "User name and password do not match."
    NOT_ALLOWED = "not_allowed", 403, "The user or token does not have the permission."
    REAUTHENTICATION_REQUIRED = "reauthentication_required", 403, "Confirm the password, then repeat."
    FOREIGN_REQUEST = "foreign_request", 403, "Another website sent the request, or for another host name."
    NOT_FOUND = "not_found", 404, "The requested object does not exist."
    UNKNOWN_ADDRESS = "unknown_address", 404, "No operation has this address."
    UNKNOWN_TRACKER = "unknown_tracker", 404, "No tracker has this id."
    UNKNOWN_RECORDING = "unknown_recording", 404, "No recording has this id."
    UNKNOWN_ALARM = "unknown_alarm", 404, "No active alarm has this id."
    UNKNOWN_PAPER = "unknown_paper", 404, "No paper has this name."
    UNKNOWN_STUDY = "unknown_study", 404, "No study or weather file has this name."
    METHOD_NOT_ALLOWED = "method_not_allowed", 405, "The header Allow lists the methods of this address."
    COMMAND_REJECTED = "command_rejected", 409, "The state forbids it; `reasons` has every unmet condition."
    PAGE_OUTDATED = "page_outdated", 409, "The page is from before an upgrade or restart."
    NETWORK_BUSY = "network_busy", 409, "A change of the network settings is on trial already."
    NOT_ON_TRIAL = "not_on_trial", 409, "No network settings are on trial, or under another ticket."
    PRECONDITION_FAILED = "precondition_failed", 412, "The settings have changed since `If-Match` was read."
    TOO_LARGE = "too_large", 413, "The body is larger than accepted."
    INVALID_VALUES = "invalid_values", 422, "Values are missing or wrong; `errors` has each."
    NOT_ACCEPTABLE = "not_acceptable", 422, "Well-formed, but impossible; `detail` says what to change."
    NESTED_TOO_DEEP = "nested_too_deep", 422, "The JSON is nested too deep."
    ACCOUNT_REFUSED = "account_refused", 422, "The change of a user, password, or token is impossible."
    INSTANT_REFUSED = "instant_refused", 422, "No sun position can be computed for this instant."
    ALGORITHM_MISSING = "algorithm_missing", 422, "The library of this algorithm is not installed."
    WEATHER_FILE_REFUSED = "weather_file_refused", 422, "The weather file cannot be used."
    CONTROL_HELD = "control_held", 423, "Another user has control; `reasons` says who."
    CONTROL_LOST = "control_lost", 423, "Control has changed since the `Control-Epoch` of the command."
    TOO_MANY_ATTEMPTS = "too_many_attempts", 429, "Too many wrong passwords; `Retry-After` says how long."
    TOO_MANY_SIGN_INS = "too_many_sign_ins", 429, "Too many users sign in at the same time."
    TOO_MANY_REQUESTS = "too_many_requests", 429, "Too much of this is under way."
    INTERNAL_ERROR = "internal_error", 500, "An unexpected error; the log of Heliopanel has the details."
    EXTRA_MISSING = "extra_missing", 501, "An optional part of the installation is missing."
    UNREACHABLE = "unreachable", 503, "Drive or database cannot be reached; `reasons` says which."
    CONTROLLER_UNREACHABLE = "controller_unreachable", 503, "The controller service does not answer."
    STORE_FAILED = "store_failed", 503, "The database could not do it."
    NOT_SET_UP = "not_set_up", 503, "No administrator has been set up yet."
    TOO_MANY_CONNECTIONS = "too_many_connections", 503, "Too many connections are open."


class SettingsChanged(Exception):
    """Settings are not those any more that a request is to change; the text says what to do."""


@dataclass(frozen=True, slots=True)
class Fault:
    """One wrong value of a request."""

    detail: Annotated[str, Field(description="What is wrong with it.")]
    pointer: Annotated[
        str | None, Field(description="JSON Pointer (RFC 6901) into the body, such as `#/latitude_deg`.")
    ] = None
    parameter: Annotated[
        str | None, Field(description="Name of the query parameter, header, or part of the path.")
    ] = None


@dataclass(frozen=True, slots=True)
class Problem:
    """What went wrong, for the user who reads it and for the program that goes by its code."""

    code: ProblemCode
    detail: Message
    reasons: tuple[Reason, ...] = ()
    errors: tuple[Fault, ...] = ()
    headers: dict[str, str] = field(default_factory=dict)

    @property
    def status(self) -> int:
        """Return the HTTP status."""
        return self.code.status

    @property
    def title(self) -> str:
        """Return the status in words."""
        return phrase(self.status)

    def body(self) -> bytes:
        """Return the problem as RFC 9457 has it."""
        told: dict[str, Any] = {
            "type": self.code.type,
            "code": self.code.value,
            "title": self.title,
            "status": self.status,
            "detail": self.detail.encode(errors="replace").decode(),
        }
        if self.reasons:
            told["reasons"] = self.reasons
        if self.errors:
            told["errors"] = [_given(one) for one in self.errors]
        return orjson.dumps(told)


def _given(fault: Fault) -> dict[str, str]:
    told = {"pointer": fault.pointer, "parameter": fault.parameter, "detail": fault.detail}
    return {name: value for name, value in told.items() if value is not None}


_BY_STATUS = {
    404: ProblemCode.UNKNOWN_ADDRESS,
    405: ProblemCode.METHOD_NOT_ALLOWED,
    413: ProblemCode.TOO_LARGE,
    500: ProblemCode.INTERNAL_ERROR,
}


def code_of_status(status: int) -> ProblemCode:
    """Return the code of what the framework refuses, of which it tells the status alone."""
    return _BY_STATUS.get(status, ProblemCode.UNREADABLE)
