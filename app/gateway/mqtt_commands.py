"""Commands over MQTT: read, sent through the same orders as every door, and answered."""

from dataclasses import asdict
from typing import Annotated, Literal

import orjson
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from app.gateway.ports import MQTT, Door, refused
from app.instants import Instant
from app.link.messages import MachineUnreachable, Order, UnknownTracker
from app.tracker.commands import Command, CommandRejected, Home, Move, Park, ResetFault, Stop, Track
from app.tracker.config import Orientation
from app.tracker.reason import Reason


class _Message(BaseModel):
    """What every command carries: who asks, and what keeps a repeat or a late one from being carried out."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)

    client: str = Field(min_length=1, max_length=40, pattern=r"^[\w.@ -]+$")
    key: str | None = Field(None, min_length=1, max_length=64)
    issued_at: Instant | None = None


class _Plain(_Message):
    """A command without values."""

    type: Literal["track", "park", "stop", "home", "reset_fault"]

    def command(self) -> Command:
        return PLAIN[self.type]()


class _Move(_Message):
    """Go to an orientation and stay there."""

    type: Literal["move"]
    azimuth_deg: float = Field(ge=0, lt=360)
    elevation_deg: float = Field(ge=-90, le=90)

    def command(self) -> Command:
        return Move(Orientation(self.azimuth_deg, self.elevation_deg))


PLAIN: dict[str, type[Track | Park | Stop | Home | ResetFault]] = {
    "track": Track,
    "park": Park,
    "stop": Stop,
    "home": Home,
    "reset_fault": ResetFault,
}
UNNAMED = "unnamed"
"""Who stopped, where a message does not say it rightly."""
RETAINED = Reason(
    "retained",
    "A retained command is not carried out: every new connection would repeat it.",
    "Send the command again without the retain flag, and clear the retained message with an empty one.",
)
MESSAGES: TypeAdapter[_Plain | _Move] = TypeAdapter(Annotated[_Plain | _Move, Field(discriminator="type")])


TOO_MANY = Reason(
    "too_many",
    "Too many commands arrived over MQTT; this command was not carried out.",
    "Send commands more slowly.",
)


async def obey(door: Door, tracker_id: str, payload: bytes, *, against: tuple[Reason, ...] = ()) -> bytes:
    """Carry out one command and return the answer: its key, whether it was accepted, and if not why.

    `against` says why it is not carried out, unless it is a stop. What asks for a stop is a stop, whatever
    else is wrong with the message.
    """
    try:
        message = MESSAGES.validate_json(payload)
    except ValidationError as error:
        if not is_stop(payload):
            return _answer(None, _malformed(error))
        message = _Plain(type="stop", client=UNNAMED)
    actor = f"mqtt {message.client}"
    goes = message.type == "stop" or not against
    reasons = await _carry_out(door, tracker_id, message, actor) if goes else against
    if reasons:
        told = " ".join(reason.message for reason in reasons)
        refused(door, tracker_id, actor, f"{message.type} over MQTT was refused: {told}")
    return _answer(message.key, *reasons)


async def _carry_out(door: Door, tracker_id: str, message: _Plain | _Move, actor: str) -> tuple[Reason, ...]:
    """Return why it was refused, nothing if it was carried out."""
    order = Order(message.command(), actor, tracker_id, message.key, message.issued_at, MQTT)
    try:
        await door.execute(order)
    except CommandRejected as rejected:
        return rejected.reasons
    except (UnknownTracker, MachineUnreachable, ValueError) as error:
        return (Reason(type(error).__name__, str(error)),)
    return ()


def is_stop(payload: bytes) -> bool:
    """Return whether a message asks for a stop."""
    try:
        said = orjson.loads(payload)
    except orjson.JSONDecodeError:
        return False
    return isinstance(said, dict) and said.get("type") == "stop"


def _malformed(error: ValidationError) -> Reason:
    places = "; ".join(
        f"{'.'.join(map(str, one['loc'])) or 'message'}: {one['msg']}" for one in error.errors()
    )
    return Reason(
        "malformed", f"This is not a valid command: {places}.", "The MQTT document lists every command."
    )


def _answer(key: str | None, *reasons: Reason) -> bytes:
    return orjson.dumps(
        {"key": key, "accepted": not reasons, "reasons": [asdict(reason) for reason in reasons]}
    )
