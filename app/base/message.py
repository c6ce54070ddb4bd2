"""What the program says to people: an English template and its values, rendered where somebody reads.

A message is the finished English text, so that whatever compares, stores or logs texts goes on with it; a
page, a record or a letter makes it anew from the template and the values in the language of its reader.
"""

import json
from collections.abc import Iterable, Mapping
from datetime import date, datetime, time
from enum import Enum
from typing import Any

EMPTY: Mapping[str, object] = {}
WHOLE = "whole"
"""The context in which pydantic writes messages with their templates and values."""
CONTEXT_END = "\x04"
"""What gettext puts between a context and a text."""
_new = str.__new__


class Shown(str):
    """A number or an instant as a sentence has it, which knows its value and its format, such as `.1f`."""

    __slots__ = ("spec", "value")
    value: Any
    spec: str


class Word(str):
    """A word that travels, such as `azimuth`: looked up by itself or by its label, never a name."""

    __slots__ = ()


class Message(str):
    """A finished English text that knows its template and its values; an alike text without is its equal.

    Values are numbers and instants (`Shown` where a format belongs to them), names as plain text, which are
    never looked up, words (`Word`, or an enumeration's) and messages, which are rendered in turn.
    """

    __slots__ = ("template", "values")
    template: str
    values: Mapping[str, object]

    def __add__(self, other: str) -> "Message":
        return join("", (self, other))

    def __radd__(self, other: str) -> "Message":
        return join("", (other, self))

    def __reduce__(self) -> tuple[Any, ...]:
        return made, (str(self), self.template, self.values)

    def __deepcopy__(self, _memo: object) -> "Message":
        return self

    @classmethod
    def __get_pydantic_core_schema__(cls, _source: object, _handler: object) -> dict[str, Any]:
        """Tell pydantic, which the core does not know: in is what `encoded` made, out is the English text.

        Out is all of it where the context is `WHOLE`, as for what is stored.
        """
        written = {"type": "function-plain", "function": _written, "info_arg": True}
        return {
            "type": "function-plain",
            "function": {"type": "no-info", "function": message_of},
            "serialization": written,
        }

    @classmethod
    def __get_pydantic_json_schema__(cls, _schema: object, _handler: object) -> dict[str, Any]:
        return {"type": "string"}


def made(text: str, template: str, values: Mapping[str, object]) -> Message:
    """Return a message with a text that was made before."""
    message = _new(Message, text)
    message.template, message.values = template, values
    return message


def say(template: str, /, **values: object) -> Message:
    """Return a sentence of the program; each gap of the template is filled with the value of its name."""
    message = _new(Message, template.format_map(values))
    message.template, message.values = template, values
    return message


def say_in(context: str, template: str, /, **values: object) -> Message:
    """Return a sentence or a word that the catalogues have for one place of use only."""
    return made(template.format_map(values), f"{context}{CONTEXT_END}{template}", values)


def data(text: str) -> Message:
    """Return as a message what others wrote or named, which no language has."""
    return made(text, "{text}", {"text": str(text)})


def N_(text: str) -> Message:  # noqa: N802 - the name that gettext's tools know
    """Mark a text without gaps for the catalogues."""
    return plain(text)


def plain(text: str) -> Message:
    """Return a text as a message; one that is a message stays what it is."""
    return text if isinstance(text, Message) else made(text, text, EMPTY)


NOTHING = plain("")


def word(text: str) -> Message | Word:
    """Return a label or a word to stand in a gap, looked up by itself."""
    return text if isinstance(text, Message | Word) else Word(text)


def with_format(value: Any, written: str) -> Shown:
    """Return a number or an instant as a format writes it."""
    text = _new(Shown, format(value, written))
    text.value, text.spec = value, written
    return text


def join(between: str, parts: Iterable[str]) -> Message:
    """Return texts one after the other, such as `azimuth and elevation`, each rendered for itself."""
    given = tuple(parts)
    if len(given) == 1:
        return plain(given[0])
    values = {f"part{number}": part for number, part in enumerate(given, start=1)}
    return made(between.join(given), between.join(f"{{{name}}}" for name in values), values)


def told_by(error: BaseException) -> Message:
    """Return what an error says."""
    text = error.args[0] if len(error.args) == 1 else ""
    return text if isinstance(text, Message) else plain(str(error))


def told_of_value(wrong: Mapping[str, Any]) -> Message:
    """Return what one entry of pydantic's errors says: our own sentence where a validator raised it."""
    error = wrong.get("ctx", EMPTY).get("error")
    return told_by(error) if isinstance(error, ValueError) else plain(str(wrong["msg"]))


def encoded(message: str) -> str | dict[str, Any]:
    """Return a message as plain data: a text without values is only that."""
    if not isinstance(message, Message) or (not message.values and message.template == message):
        return str(message)
    return {
        "text": str(message),
        "template": message.template,
        "values": {name: _encoded_value(value) for name, value in message.values.items()},
    }


def parts_of(text: str) -> str | None:
    """Return template and values as JSON, to be stored beside a text that has any."""
    told = encoded(text)
    return None if isinstance(told, str) else json.dumps(told, sort_keys=True)


def with_parts(text: str, parts: str | None) -> str:
    """Return a stored text as the message it was; parts that say anything else are not believed."""
    if parts is None:
        return text
    try:
        found = message_of(json.loads(parts))
        return found if found == _made_anew(found) == text else text
    except (ValueError, KeyError):
        return text


def _made_anew(message: Message) -> str:
    values = {
        name: _made_anew(value) if isinstance(value, Message) else value
        for name, value in message.values.items()
    }
    return message.template.rpartition(CONTEXT_END)[2].format_map(values)


def _written(message: Message, info: Any) -> str | dict[str, Any]:
    return encoded(message) if info.context == WHOLE else str(message)


def _encoded_value(value: object) -> object:
    match value:
        case Message():
            return {"template": value.template} if not value.values else encoded(value)
        case Word() | Enum():
            return {"word": str(value)}
        case Shown(value=date() | time() as at):
            return {"at": at.isoformat(), "format": value.spec}
        case Shown(value=number):
            return {"number": number if isinstance(number, int) else float(number), "format": value.spec}
        case bool() | int() | float() | str():
            return value
        case _:
            return str(value)


def message_of(told: object) -> Message:
    """Return the message of what `encoded` made, or of a plain text; raise `ValueError` for others."""
    match told:
        case str():
            return plain(told)
        case {"text": str(text), "template": str(template), "values": dict(values)}:
            return made(text, template, {name: _value_of(value) for name, value in values.items()})
        case _:
            raise ValueError("A message is a text, or a text with its template and its values.")


def _value_of(told: object) -> object:
    match told:
        case {"word": str(word)}:
            return Word(word)
        case {"at": str(at), "format": str(written)}:
            return with_format(_instant(at), written)
        case {"number": int() | float() as number, "format": str(written)}:
            return with_format(number, written)
        case {"template": str(template), **rest} if "text" not in rest:
            return plain(template)
        case dict():
            return message_of(told)
        case _:
            return told


def _instant(text: str) -> date | time:
    if "T" in text:
        return datetime.fromisoformat(text)
    return date.fromisoformat(text) if text.count("-") == 2 else time.fromisoformat(text)
