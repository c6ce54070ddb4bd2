"""What a journal entry says: its English text in a column, its template and values with the entry's data."""

from typing import Any

from app.base.message import Message, encoded, message_of
from app.base.message import plain as as_message
from app.store.documents import plain
from app.tracker.state.snapshot import Event

KEY = "_message"


def with_message(event: Event) -> dict[str, Any]:
    """Return what to store as an event's data: with template and values where its text has values.

    Of a text that no database holds as it is, the text made plain is kept alone.
    """
    told = encoded(event.message)
    if isinstance(told, str) or plain(event.message) != event.message:
        return event.data
    return {**event.data, KEY: told}


def kept_message(text: str, data: dict[str, Any]) -> Message:
    """Take the message out of stored data and return it; an entry of a former version has only its text."""
    told = data.pop(KEY, None)
    try:
        return as_message(text) if told is None else message_of(told)
    except ValueError:
        return as_message(text)
