"""Mounts and actuators as they come in."""

from typing import Annotated

from pydantic import Field

from app.tracker.config import MountKind
from app.web.api.base import Input

Millimetres = Annotated[float, Field(ge=-100_000, le=100_000)]
Length = Annotated[float, Field(gt=0, le=100_000)]


class RowsIn(Input):
    """Rows of single-axis trackers that would shade each other."""

    ground_coverage_ratio: float = Field(gt=0, le=1, description="Panel width over distance of row axes.")
    cross_axis_tilt_deg: float = Field(0.0, ge=-60, le=60, description="Slope across the rows, as pvlib.")


class MountChange(Input):
    """How the panel hangs on its axes; what is left out stays, another kind brings its usual limits."""

    kind: MountKind | None = None
    axis_azimuth_deg: float | None = Field(None, ge=0, lt=360, description="Where the first axis points.")
    axis_tilt_deg: float | None = Field(None, ge=0, le=90, description="By how much it dips there.")
    panel_tilt_deg: float | None = Field(None, ge=0, le=90, description="Of a panel on a vertical axis.")
    rows: RowsIn | None = Field(None, description="Given: rows backtrack; null: they do not.")
    least_incidence: bool | None = Field(None, description="Elevation tracking by least incidence.")


class PointIn(Input):
    """A place in the frame of an axis: z along it, a growing angle turns x towards y."""

    x_mm: Millimetres
    y_mm: Millimetres
    z_mm: Millimetres = 0.0


class ActuatorIn(Input):
    """A linear actuator that turns an axis, by its points; complete in itself."""

    base: PointIn
    joint: PointIn
    at_deg: float = Field(ge=-720, le=720, description="Axis angle at which the joint is where given.")
    retracted_mm: Length
    travel_mm: Length
    speed_mm_s: Length
