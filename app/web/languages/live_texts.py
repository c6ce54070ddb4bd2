"""What a page is sent while it stands, with its sentences in the language of the page."""

from typing import Any

import orjson

from app.web.languages.catalogue import Catalogue

_SENTENCES = "message hint activity_text title do text detail home_lost how"
SENTENCES = frozenset(_SENTENCES.split())
"""The fields of a snapshot, an event or an answer that people read; all else is for programs or a name."""
OF_THE_SITE = SENTENCES | {"where"}
"""The same of what belongs to no tracker: where it stands is a word then, and no name."""


def in_language(catalogue: Catalogue, told: Any) -> str:
    """Return as JSON what is told, its sentences in a language."""
    encoded = orjson.dumps(told)
    if not catalogue.texts:
        return encoded.decode()
    return orjson.dumps(_said(catalogue, orjson.loads(encoded))).decode()


def _said(catalogue: Catalogue, value: Any) -> Any:
    match value:
        case dict():
            read = OF_THE_SITE if value.get("tracker_id", "") is None else SENTENCES
            return {name: _field(catalogue, inner, is_read=name in read) for name, inner in value.items()}
        case list():
            return [_said(catalogue, inner) for inner in value]
        case _:
            return value


def _field(catalogue: Catalogue, value: Any, *, is_read: bool) -> Any:
    if isinstance(value, str):
        return catalogue.said(value) if is_read and value else value
    return _said(catalogue, value)
