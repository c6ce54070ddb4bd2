"""What a page is sent while it stands, with its sentences in the language of the page."""

from typing import Any

import orjson

from app.web.languages.catalogue import Catalogue

SENTENCES = frozenset({"message", "hint", "activity_text", "title", "do", "text", "detail", "home_lost"})
"""The fields of a snapshot, an event or an answer that people read; all else is for programs or a name."""


def in_language(catalogue: Catalogue, told: Any) -> str:
    """Return as JSON what is told, its sentences in a language."""
    encoded = orjson.dumps(told)
    if not catalogue.texts:
        return encoded.decode()
    return orjson.dumps(_said(catalogue, orjson.loads(encoded))).decode()


def _said(catalogue: Catalogue, value: Any) -> Any:
    match value:
        case dict():
            return {name: _field(catalogue, name, inner) for name, inner in value.items()}
        case list():
            return [_said(catalogue, inner) for inner in value]
        case _:
            return value


def _field(catalogue: Catalogue, name: str, value: Any) -> Any:
    if isinstance(value, str):
        return catalogue.said(value) if name in SENTENCES and value else value
    return _said(catalogue, value)
