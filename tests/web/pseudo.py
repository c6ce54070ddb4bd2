"""A language that nobody speaks: between ⟦ and ⟧, in wide letters, so that what is not translated shows."""

import re
from html.parser import HTMLParser
from io import BytesIO

from fastapi import FastAPI
from starlette.middleware import Middleware
from starlette.types import ASGIApp, Receive, Scope, Send

from app.web.languages import CATALOGUE
from app.web.languages.catalogue import DOCUMENTS, Catalogue
from app.web.languages.known import LANGUAGES
from app.web.translation.catalogues import mo_bytes, template

READ_ATTRIBUTES = ("aria-label", "aria-description", "aria-valuetext", "title", "placeholder", "alt", "label")
VOID = frozenset(("area", "base", "br", "col", "hr", "img", "input", "link", "meta", "source", "wbr"))
UNREAD = frozenset(("script", "style", "code", "kbd"))
PICTURE = re.compile(r"!\[([^]]*)\]")
KEPT = re.compile(r"\{[a-z][a-z0-9_]*\}|%\([a-z0-9_]+\)s|<[^>]*>|&[a-z]+;|`[^`]*`|\]\([^)]*\)|https?://\S+")
"""What every language has as English has it: gaps, tags, code, links and addresses."""
WIDE = {code: code + 0xFF21 - ord("A") for code in range(ord("A"), ord("z") + 1) if chr(code).isalpha()}
WORD = re.compile(r"[^\W\d_]{3,}")


def wide(text: str) -> str:
    """Return a text in wide letters, which no English text has."""
    kept = [*KEPT.findall(text), ""]
    plain = [part.translate(WIDE) for part in KEPT.split(text)]
    return "".join(part + same for part, same in zip(plain, kept, strict=True))


def pseudo_catalogue() -> Catalogue:
    """Return every text of the sources between brackets in wide letters."""
    catalog = template()
    catalog.locale = "de"
    for text in catalog:
        if isinstance(text.id, tuple):
            text.string = tuple(f"⟦{wide(form)}⟧" for form in text.id)
        elif text.id:
            text.string = f"⟦{wide(text.id)}⟧"
    blocks = {text.id: PICTURE.sub(r"![⟦\1⟧]", text.string) for text in catalog if text.context == DOCUMENTS}
    return Catalogue(LANGUAGES["de"], BytesIO(mo_bytes(catalog)), lambda: blocks)


class Speaking:
    """Answers every request in one catalogue, whatever was chosen."""

    def __init__(self, app: ASGIApp, catalogue: Catalogue) -> None:
        self._app = app
        self._catalogue = catalogue

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        CATALOGUE.set(self._catalogue)
        await self._app(scope, receive, send)


def speaking(app: FastAPI, catalogue: Catalogue) -> FastAPI:
    """Return a panel that speaks one catalogue."""
    app.user_middleware.append(Middleware(Speaking, catalogue=catalogue))
    return app


class Reading(HTMLParser):
    """Collects what people read on a page and is not between brackets."""

    def __init__(self) -> None:
        super().__init__()
        self.untranslated: list[str] = []
        self._open: list[tuple[str, bool]] = []
        self._depth = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        kept = given.get("translate") == "no" or (tag != "html" and given.get("lang") == "en")
        if not self._is_kept and not kept:
            for name in READ_ATTRIBUTES:
                self._note(given.get(name) or "", 0)
            if tag == "input" and given.get("type") in ("submit", "button"):
                self._note(given.get("value") or "", 0)
        if tag not in VOID:
            self._open.append((tag, self._is_kept or kept or tag in UNREAD))

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.handle_endtag(tag)

    def handle_endtag(self, tag: str) -> None:
        while self._open and self._open.pop()[0] != tag:
            pass

    def handle_data(self, data: str) -> None:
        if not self._is_kept:
            self._depth = self._note(data, self._depth)

    @property
    def _is_kept(self) -> bool:
        return bool(self._open and self._open[-1][1])

    def _note(self, text: str, depth: int) -> int:
        outside = ""
        for letter in text:
            depth += (letter == "⟦") - (letter == "⟧")
            is_ours = depth > 0 and ord(letter) not in WIDE and letter not in " .,:;/_-()"
            outside += " " if is_ours or letter in "⟦⟧" else letter
        bare = " ".join(outside.split())
        if WORD.search(bare):
            self.untranslated.append(bare)
        return max(depth, 0)


def untranslated(page: str) -> list[str]:
    """Return every piece of a page that people read and that is not between brackets."""
    reading = Reading()
    reading.feed(page)
    return reading.untranslated
