"""Commands over MQTT: read, sent through the same orders as every door, and answered."""

import re
from collections.abc import Iterable
from dataclasses import asdict
from typing import Annotated, Any, Union, get_args

import orjson
from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from app.base.instants import Instant
from app.base.message import N_, join, say, told_by
from app.gateway.ports import MQTT, Door, refused
from app.link.messages import MachineUnreachable, Order, UnknownTracker
from app.link.order_models import OrderModel, order_model
from app.link.orders import kind_of
from app.tracker.commands.commands import Command, CommandRejected, Stop
from app.tracker.values.order_spec import Interface
from app.tracker.values.reason import Reason


class Message(OrderModel):
    """What every command carries: who asks, and what keeps a repeat or a late one from being carried out."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)

    client: str = Field(min_length=1, max_length=40, pattern=r"^[\w.@ -]+$")
    key: str | None = Field(None, min_length=1, max_length=64)
    issued_at: Instant | None = None


UNNAMED = "unnamed"
"""Who stopped, where a message does not say it rightly."""
RETAINED = Reason(
    "retained",
    N_("A retained command is not carried out: every new connection would repeat it."),
    N_("Send the command again without the retain flag, and clear the retained message with an empty one."),
)
MODELS = {one: order_model(one, Message) for one in get_args(Command) if Interface.MQTT in one.spec.by}
STOP_ANYWHERE = re.compile(rb'"type"\s*:\s*"stop"')
MOST_PLACES, LONGEST_PLACE = 5, 60
_ANY: Any = Annotated[Union[tuple(MODELS.values())], Field(discriminator="type")]  # noqa: UP007
MESSAGES: TypeAdapter[Message] = TypeAdapter(_ANY)
UNNAMED_STOP = MODELS[Stop].model_validate({"type": "stop", "client": UNNAMED})


TOO_MANY = Reason(
    "too_many",
    N_("Too many commands arrived over MQTT; this command was not carried out."),
    N_("Send commands more slowly."),
)


async def obey(door: Door, tracker_id: str, payload: bytes, *, against: tuple[Reason, ...] = ()) -> bytes:
    """Carry out one command and return the answer: its key, whether it was accepted, and if not why.

    `against` says why it is not carried out, unless it is a stop. What asks for a stop is a stop, whatever
    else is wrong with the message.
    """
    asks_for_stop = is_stop(payload)
    try:
        message = MESSAGES.validate_json(payload)
    except ValidationError as error:
        if not asks_for_stop:
            return _answer(None, _malformed(error))
        message = UNNAMED_STOP
    if asks_for_stop and message.order is not Stop:
        message = UNNAMED_STOP
    actor = f"mqtt {message.client}"
    goes = message.order is Stop or not against
    reasons = await _carry_out(door, tracker_id, message, actor) if goes else against
    if reasons:
        told = join(" ", (reason.message for reason in reasons))
        refused(
            door,
            tracker_id,
            actor,
            say("{type} over MQTT was refused: {told}", type=kind_of(message.order), told=told),
        )
    return _answer(message.key, *reasons)


async def _carry_out(door: Door, tracker_id: str, message: Message, actor: str) -> tuple[Reason, ...]:
    """Return why it was refused, nothing if it was carried out."""
    order = Order(message.command(), actor, tracker_id, message.key, message.issued_at, MQTT)
    try:
        await door.execute(order)
    except CommandRejected as rejected:
        return rejected.reasons
    except (UnknownTracker, MachineUnreachable, ValueError) as error:
        return (Reason(type(error).__name__, told_by(error)),)
    return ()


def is_stop(payload: bytes) -> bool:
    """Return whether a message asks for a stop, be the rest of it JSON or not."""
    try:
        said = orjson.loads(payload)
    except orjson.JSONDecodeError:
        said = None
    return (isinstance(said, dict) and said.get("type") == "stop") or STOP_ANYWHERE.search(
        payload
    ) is not None


def _malformed(error: ValidationError) -> Reason:
    wrong = error.errors()[:MOST_PLACES]
    places = join("; ", (f"{_place(one['loc'])}: {one['msg']}" for one in wrong))
    return Reason(
        "malformed",
        say("This is not a valid command: {places}.", places=places),
        N_("The MQTT document lists every command."),
    )


def _place(names: Iterable[object]) -> str:
    """Return where a message is wrong; a sender's own name is cut, and shown without what is not visible."""
    place = ".".join(map(str, names))[:LONGEST_PLACE].encode("unicode_escape").decode("ascii")
    return place or "message"


def _answer(key: str | None, *reasons: Reason) -> bytes:
    return orjson.dumps(
        {"key": key, "accepted": not reasons, "reasons": [asdict(reason) for reason in reasons]}
    )
