"""The horizon on the machine: kept, journalled, and told with every snapshot."""

from app.link.place_orders import SetHorizon
from app.sun.horizon import Horizon
from app.tracker.state.snapshot import EventKind
from tests.site.plant import Plant


async def test_the_site_tells_that_the_sun_is_behind_the_entered_horizon(plant: Plant) -> None:
    await plant.commission()
    sun = plant.site.latest().sun
    assert sun is not None
    assert sun.apparent_elevation_deg > 5.0
    assert not plant.site.latest().sun_behind_horizon

    wall = Horizon(((0.0, sun.apparent_elevation_deg + 2.0),))
    await plant.ask(SetHorizon(wall))
    assert plant.site.latest().sun_behind_horizon
    assert plant.site.model.state.horizon == wall
    (event,) = plant.happened(EventKind.HORIZON_SET)
    assert event.message == "The horizon was set: 1 point."

    await plant.ask(SetHorizon(Horizon(((0.0, 1.0),))))
    assert not plant.site.latest().sun_behind_horizon
