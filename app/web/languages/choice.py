"""Which language a request is answered in: what its cookie says, else what its browser asks for."""

from collections.abc import Container, Iterator

from starlette.datastructures import Headers
from starlette.requests import cookie_parser
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_for, offered
from app.web.languages.known import ENGLISH, LANGUAGES

COOKIE = "language"
MOST_ASKED = 20
LONGEST_HEADER = 1000
CHINESE = "zh_Hans"


class Speech:
    """Lets everything that answers a request, errors included, speak its language.

    The catalogue is not taken back afterwards: what answers an unforeseen error does so further out, and the
    server gives every request a context of its own.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Choose the language and pass the request on."""
        if scope["type"] in ("http", "websocket"):
            CATALOGUE.set(await catalogue_for(chosen(Headers(scope=scope))))
        await self._app(scope, receive, send)


def chosen(headers: Headers) -> str:
    """Return the code of the language that a request wants; English where it wants none of ours."""
    kept = cookie_parser(headers.get("cookie", "")).get(COOKIE)
    codes = frozenset(one.code for one in offered())
    return kept if kept in codes else asked_for(headers.get("accept-language", ""), codes)


def asked_for(accepted: str, codes: Container[str] = LANGUAGES) -> str:
    """Return which of these languages a browser likes best, by the weights of its `Accept-Language`."""
    weighed = sorted(_weighed(accepted[:LONGEST_HEADER]), key=lambda one: -one[0])
    return next((code for _, code in weighed if code in codes), ENGLISH.code)


def _weighed(accepted: str) -> Iterator[tuple[float, str]]:
    for one in accepted.split(",")[:MOST_ASKED]:
        tag, _, weight = one.partition(";")
        primary = tag.strip().lower().partition("-")[0]
        code = CHINESE if primary == "zh" else primary
        if code in LANGUAGES and (worth := _weight(weight)) > 0.0:
            yield worth, code


def _weight(text: str) -> float:
    name, _, number = text.strip().partition("=")
    try:
        return float(number) if name.strip() == "q" else 1.0
    except ValueError:
        return 0.0
