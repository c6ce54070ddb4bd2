"""What a page is sent while it stands, with its sentences in the language of the page."""

from typing import Any

import orjson

from app.base.message import Message
from app.web.languages.catalogue import Catalogue


def in_language(catalogue: Catalogue, told: Any) -> str:
    """Return as JSON what is told, its messages in a language."""
    if not catalogue.texts:
        return orjson.dumps(told).decode()

    def rendered(value: Any) -> str:
        # A text that is not translated is the message itself, which would be asked for again.
        return str(catalogue.said(value) if isinstance(value, Message) else value)

    return orjson.dumps(told, default=rendered, option=orjson.OPT_PASSTHROUGH_SUBCLASS).decode()
