"""The commands at the ends of what an axis's settings allow, tried on a dialect's own encoder."""

from collections.abc import Iterator, Mapping

from app.base.message import join, say, told_by, with_format
from app.drives.dialects.gearing import RAMPS, SPEEDS
from app.drives.register import NUMBER, Register, ValueMisfit
from app.tracker.settings.axes import Axis, AxisConfig
from app.tracker.values.motion import Position, Velocity

DEGREES_A_SECOND = "deg/s"


def extremes(axis: AxisConfig) -> Iterator[Position | Velocity]:
    """Yield moves to both soft limits, and turns in both directions, at every speed of an axis."""
    for speed_dps in sorted({axis.jog_slow_dps, axis.jog_fast_dps, axis.speed_dps}):
        yield Position(axis.minimum_deg, speed_dps)
        yield Position(axis.maximum_deg, speed_dps)
        yield Velocity(-speed_dps)
        yield Velocity(speed_dps)


def check_encoded(axis: Axis, registers: Mapping[str, Register], values: Mapping[str, float]) -> None:
    """Raise `ValueMisfit`, with what to change, for a value of a command that its register cannot hold.

    A speed or an acceleration that becomes zero in its register would not move the axis.
    """
    for name, value in values.items():
        register = registers.get(name)
        if register is None:
            continue
        try:
            _check(register, value)
        except ValueMisfit as misfit:
            raise ValueMisfit(join(" ", (told_by(misfit), _advice(axis, register)))) from misfit


def _check(register: Register, value: float) -> None:
    if register.packed(value) or not value or not _is_rate(register):
        return
    raise ValueMisfit(
        say(
            "{value} becomes zero in register {name} ({address}), which counts {least} {unit}.",
            value=with_format(value, NUMBER),
            name=register.name,
            address=register.address,
            least=with_format(register.scale, NUMBER),
            unit=register.unit,
        )
    )


def _is_rate(register: Register) -> bool:
    return register.unit in RAMPS or register.unit in SPEEDS or register.unit == DEGREES_A_SECOND


def _advice(axis: Axis, register: Register) -> str:
    """Return what to change so that the value fits."""
    if register.unit in RAMPS:
        return say("Change the acceleration or the gear ratio of the {axis} axis.", axis=axis)
    if _is_rate(register):
        return say("Change the speeds or the gear ratio of the {axis} axis.", axis=axis)
    return say("Change the soft limits, the speeds, or the gear ratio of the {axis} axis.", axis=axis)
