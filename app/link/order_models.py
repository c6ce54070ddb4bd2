"""What programs send for an order, made from the order's dataclass: over REST and MQTT alike."""

import inspect
from collections.abc import Iterator
from dataclasses import MISSING, Field, fields
from typing import Annotated, Any, ClassVar, Literal, TypeVar, get_args, get_origin

import pydantic

from app.link.orders import kind_of
from app.tracker.commands.commands import Command
from app.tracker.settings.config import Orientation
from app.tracker.values.order_spec import Value

Azimuth = Annotated[float, pydantic.Field(ge=0, lt=360, description="Degrees clockwise from true north.")]
Elevation = Annotated[float, pydantic.Field(ge=-90, le=90, description="Degrees above the horizon.")]


class OrderModel(pydantic.BaseModel):
    """What all commands of one interface carry; `order` is what such a message asks for."""

    order: ClassVar[type[Command]]

    def command(self) -> Command:
        """Return what the machine is asked."""
        return self.order(**{field.name: self._value(field) for field in _asked(self.order)})

    def _value(self, field: Field[Any]) -> Any:
        if field.type is Orientation:
            return Orientation(getattr(self, "azimuth_deg"), getattr(self, "elevation_deg"))  # noqa: B009
        value = getattr(self, field.name)
        return float(value) if get_args(field.type)[:1] == (float,) else value


Model = TypeVar("Model", bound=OrderModel)


def order_model(order: type[Command], base: type[Model]) -> type[Model]:
    """Return the model of an order: its values by their names, an orientation as its two angles."""
    kind = kind_of(order)
    told: dict[str, Any] = {"type": (Literal[kind], ...)}
    for field in _asked(order):
        told |= _fields(field)
    name = "".join(part.capitalize() for part in kind.split("_"))
    made = pydantic.create_model(f"{name}Command", __base__=base, __doc__=inspect.getdoc(order), **told)
    made.order = order
    return made


def _asked(order: type[Command]) -> Iterator[Field[Any]]:
    return (field for field in fields(order) if field.name != "kind")


def _fields(field: Field[Any]) -> dict[str, tuple[Any, Any]]:
    hint: Any = field.type
    if hint is Orientation:
        return {"azimuth_deg": (Azimuth, ...), "elevation_deg": (Elevation, ...)}
    default: Any = ... if field.default is MISSING else field.default
    if get_origin(hint) is not Annotated:
        return {field.name: (hint, default)}
    kind, value = get_args(hint)
    if value.choices:
        return {field.name: (Literal[value.choices], int(default))}
    return {field.name: (Annotated[kind, _bounded(value)], default)}


def _bounded(value: Value) -> Any:
    return pydantic.Field(
        ge=value.least,
        le=value.most,
        min_length=value.shortest,
        max_length=value.longest,
        description=value.told or None,
        examples=list(value.examples) or None,
    )
