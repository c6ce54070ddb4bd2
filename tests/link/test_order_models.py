"""What programs send for an order is made from the order, and becomes the order again."""

import pytest
from pydantic import ConfigDict, ValidationError

from app.link.order_models import OrderModel, order_model
from app.tracker.commands.commands import (
    Command,
    Move,
    Park,
    RunScaleTest,
    RunStopTest,
    SetInhibit,
    Step,
)
from app.tracker.memory.drive_tests import StopSpeed
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation


class Said(OrderModel):
    """What every message of these tests carries."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


@pytest.mark.parametrize(
    ("said", "order"),
    [
        ({"type": "park"}, Park()),
        ({"type": "move", "azimuth_deg": 10, "elevation_deg": -5.5}, Move(Orientation(10.0, -5.5))),
        ({"type": "step", "axis": "azimuth", "delta_deg": -5}, Step(Axis.AZIMUTH, -5.0)),
        ({"type": "set_inhibit", "name": "Ada"}, SetInhibit("Ada")),
        ({"type": "test_scale", "axis": "elevation"}, RunScaleTest(Axis.ELEVATION, 10.0)),
        ({"type": "test_stop", "axis": "azimuth", "speed": "jog"}, RunStopTest(Axis.AZIMUTH, StopSpeed.JOG)),
    ],
)
def test_a_message_is_the_order_that_it_was_made_from(said: dict[str, object], order: Command) -> None:
    made = order_model(type(order), Said).model_validate(said).command()
    assert (made, type(made)) == (order, type(order))
    assert [type(value) for value in vars_of(made)] == [type(value) for value in vars_of(order)]


def vars_of(order: Command) -> list[object]:
    return [getattr(order, name) for name in order.__dataclass_fields__ if name != "spec"]


@pytest.mark.parametrize(
    ("order", "said"),
    [
        (Move, {"type": "move", "azimuth_deg": 360, "elevation_deg": 0}),
        (Move, {"type": "move", "azimuth_deg": 0, "elevation_deg": 90.01}),
        (Move, {"type": "move", "azimuth_deg": 0}),
        (Step, {"type": "step", "axis": "azimuth", "delta_deg": 5.01}),
        (Step, {"type": "step", "axis": "azimuth", "delta_deg": "nan"}),
        (SetInhibit, {"type": "set_inhibit", "name": ""}),
        (SetInhibit, {"type": "set_inhibit", "name": "x" * 61}),
        (SetInhibit, {"type": "set_inhibit", "name": "Ada", "reason": "x" * 201}),
        (RunScaleTest, {"type": "test_scale", "axis": "azimuth", "delta_deg": 20}),
        (Park, {"type": "stop"}),
        (Park, {"type": "park", "now": True}),
    ],
)
def test_what_is_out_of_its_bounds_is_refused(order: type[Command], said: dict[str, object]) -> None:
    with pytest.raises(ValidationError):
        order_model(order, Said).model_validate(said)
