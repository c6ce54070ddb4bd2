"""The horizon of the site as it was entered by hand."""

from pydantic import Field

from app.base.message import told_by
from app.base.permission import Permission
from app.link.place_orders import SetHorizon
from app.sun.horizon import MOST_POINTS, Horizon, joined
from app.web.api.base import CHANGED, REFUSED, TAGGED, Input, Output, api_router
from app.web.api.orders import SenderDep
from app.web.api.tags import of_site, tagged, unless_changed
from app.web.http.errors import NotAcceptable
from app.web.http.needs import needs
from app.web.shell.deps import MachineDep, SnapshotDep

router = api_router(prefix="/site/horizon", tags=["site"])
HORIZON = of_site(lambda site: site.horizon)


class HorizonPoint(Input):
    """How high the horizon stands in one direction."""

    azimuth_deg: float = Field(
        ge=-180,
        le=360,
        description="Clockwise from true north, as 0 to below 360; 360 is read as 0, and -90 as 270.",
        examples=[135.0],
    )
    elevation_deg: float = Field(ge=0, lt=90, description="Above a flat horizon.", examples=[8.0])


class Skyline(Input):
    """All points in any order; the horizon runs straight between them, and without any it is flat.

    A closed list is taken: points of the same direction, such as 0 and 360, are joined where their elevations
    are the same.
    """

    points: list[HorizonPoint] = Field(max_length=MOST_POINTS + 1)


class SkylineNow(Output):
    """The entered horizon, and whether the sun stands behind it now."""

    points: list[HorizonPoint]
    sun_behind_horizon: bool


@router.get("", summary="The horizon", responses=TAGGED, dependencies=[tagged(HORIZON)])
@needs(Permission.READ)
async def read_horizon(machine: MachineDep, snapshot: SnapshotDep) -> SkylineNow:
    """Return the entered points; none where the horizon is flat."""
    horizon = (await machine.detail()).site.horizon
    return _told(horizon, sun_behind_horizon=snapshot.sun_behind_horizon)


@router.put(
    "", summary="Set the horizon", responses=CHANGED | REFUSED, dependencies=[unless_changed(HORIZON)]
)
@needs(Permission.CONFIGURE)
async def set_horizon(skyline: Skyline, sender: SenderDep) -> SkylineNow:
    """Keep these points; pictures show them and the site tells when the sun is behind them."""
    try:
        horizon = joined((one.azimuth_deg, one.elevation_deg) for one in skyline.points)
    except ValueError as error:
        raise NotAcceptable(told_by(error)) from error
    snapshot = await sender.send(SetHorizon(horizon))
    return _told(horizon, sun_behind_horizon=snapshot.sun_behind_horizon)


def _told(horizon: Horizon, *, sun_behind_horizon: bool) -> SkylineNow:
    points = [HorizonPoint(azimuth_deg=one, elevation_deg=other) for one, other in horizon.points]
    return SkylineNow(points=points, sun_behind_horizon=sun_behind_horizon)
