"""The horizon of the site as it was entered by hand."""

from pydantic import Field

from app.link.place_orders import SetHorizon
from app.sun.horizon import MOST_POINTS, Horizon
from app.web.api.base import REFUSED, Input, Output, api_router
from app.web.api.orders import SenderDep
from app.web.deps import MachineDep, SnapshotDep
from app.web.errors import NotAcceptable

router = api_router(prefix="/site/horizon", tags=["site"])


class HorizonPoint(Input):
    """How high the horizon stands in one direction."""

    azimuth_deg: float = Field(ge=0, lt=360, description="Clockwise from true north.", examples=[135.0])
    elevation_deg: float = Field(ge=0, lt=90, description="Above a flat horizon.", examples=[8.0])


class Skyline(Input):
    """All points by rising azimuth; the horizon runs straight between them, and without any it is flat."""

    points: list[HorizonPoint] = Field(max_length=MOST_POINTS)


class SkylineNow(Output):
    """The entered horizon, and whether the sun stands behind it now."""

    points: list[HorizonPoint]
    sun_behind_horizon: bool


@router.get("", summary="The horizon")
async def read_horizon(machine: MachineDep, snapshot: SnapshotDep) -> SkylineNow:
    """Return the entered points; none where the horizon is flat."""
    horizon = (await machine.detail()).site.horizon
    return _told(horizon, sun_behind_horizon=snapshot.sun_behind_horizon)


@router.put("", summary="Set the horizon", responses=REFUSED)
async def set_horizon(skyline: Skyline, sender: SenderDep) -> SkylineNow:
    """Keep these points; pictures show them and the site tells when the sun is behind them."""
    points = sorted((one.azimuth_deg, one.elevation_deg) for one in skyline.points)
    try:
        horizon = Horizon(tuple(points))
    except ValueError as error:
        raise NotAcceptable(str(error)) from error
    snapshot = await sender.send(SetHorizon(horizon))
    return _told(horizon, sun_behind_horizon=snapshot.sun_behind_horizon)


def _told(horizon: Horizon, *, sun_behind_horizon: bool) -> SkylineNow:
    points = [HorizonPoint(azimuth_deg=one, elevation_deg=other) for one, other in horizon.points]
    return SkylineNow(points=points, sun_behind_horizon=sun_behind_horizon)
