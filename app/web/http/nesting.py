"""How deep JSON may be nested: what would only keep the panel busy is turned away before it is read."""

import re
from collections.abc import Iterator
from itertools import accumulate

from starlette.datastructures import Headers
from starlette.exceptions import HTTPException
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from app.base.message import say
from app.web.http.errors import problem_response
from app.web.http.problems import Problem, ProblemCode, code_of_status
from app.web.http.security import TOO_LARGE

DEEPEST = 32
"""Levels; the deepest request of the API has six."""

TOO_DEEP = say(
    "The JSON of a request can be nested at most {deepest} levels deep; this one is "
    "deeper. Compare it with /api/v1/openapi.json.",
    deepest=DEEPEST,
)
OPENING = b"[{"
NO_BRACKETS = bytes(set(range(256)) - set(b"[]{}"))
STRINGS = re.compile(rb'"(?:[^"\\]++|\\.)*+(?:"|\\?\Z)', re.DOTALL)


class NestingLimit:
    """Reads the whole body of a JSON request first, and answers 422 where it is nested too deep."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with its body, or answer with the sentence that says why not."""
        if scope["type"] != "http" or not _is_json(scope):
            await self._app(scope, receive, send)
            return
        try:
            messages = await _whole_body(receive)
        except HTTPException as error:
            problem = Problem(code_of_status(error.status_code), TOO_LARGE, headers={"connection": "close"})
            await problem_response(problem)(scope, receive, send)
            return
        if is_too_deep(b"".join(one.get("body", b"") for one in messages)):
            await problem_response(Problem(ProblemCode.NESTED_TOO_DEEP, TOO_DEEP))(scope, receive, send)
            return
        await self._app(scope, _replayed(messages, receive), send)


def is_too_deep(body: bytes) -> bool:
    """Return whether a JSON text is nested deeper than `DEEPEST`; brackets in its strings do not count."""
    if sum(body.count(one) for one in OPENING) <= DEEPEST:
        return False
    brackets = STRINGS.sub(b"", body).translate(None, NO_BRACKETS)
    steps = (1 if one in OPENING else -1 for one in brackets)
    return any(depth > DEEPEST for depth in accumulate(steps))


def _is_json(scope: Scope) -> bool:
    headers = Headers(scope=scope)
    has_body = "content-length" in headers or "transfer-encoding" in headers
    return has_body and "json" in headers.get("content-type", "json").lower()


async def _whole_body(receive: Receive) -> list[Message]:
    """Return the messages of a request up to the end of its body; a limit outside of here bounds it."""
    messages = [await receive()]
    while messages[-1].get("more_body"):
        messages.append(await receive())
    return messages


def _replayed(messages: list[Message], receive: Receive) -> Receive:
    """Return what gives these messages first, then whatever comes."""
    waiting: Iterator[Message] = iter(messages)

    async def replay() -> Message:
        message = next(waiting, None)
        return await receive() if message is None else message

    return replay
