"""Why something is not, or should not be, done: a sentence for the person who reads it."""

from dataclasses import dataclass

from app.base.message import NOTHING, Message


@dataclass(frozen=True, slots=True)
class Reason:
    """One unmet condition: a stable code, a sentence, and what to do about it."""

    code: str
    message: Message
    hint: Message = NOTHING
