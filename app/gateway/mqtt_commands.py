"""Commands over MQTT: read, sent through the same orders as every door, and answered."""

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
_ANY: Any = Annotated[Union[tuple(MODELS.values())], Field(discriminator="type")]  # noqa: UP007
MESSAGES: TypeAdapter[Message] = TypeAdapter(_ANY)


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
    try:
        message = MESSAGES.validate_json(payload)
    except ValidationError as error:
        if not is_stop(payload):
            return _answer(None, _malformed(error))
        message = MODELS[Stop].model_validate({"type": "stop", "client": UNNAMED})
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
    """Return whether a message asks for a stop."""
    try:
        said = orjson.loads(payload)
    except orjson.JSONDecodeError:
        return False
    return isinstance(said, dict) and said.get("type") == "stop"


def _malformed(error: ValidationError) -> Reason:
    places = join(
        "; ", (f"{'.'.join(map(str, one['loc'])) or 'message'}: {one['msg']}" for one in error.errors())
    )
    return Reason(
        "malformed",
        say("This is not a valid command: {places}.", places=places),
        N_("The MQTT document lists every command."),
    )


def _answer(key: str | None, *reasons: Reason) -> bytes:
    return orjson.dumps(
        {"key": key, "accepted": not reasons, "reasons": [asdict(reason) for reason in reasons]}
    )
