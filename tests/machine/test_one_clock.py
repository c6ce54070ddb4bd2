"""One clock for a site: controller and panel follow the system's clock when it is set while they run."""

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.machine.safe_mode import _site
from app.simulation.kept_positions import KeptPositions
from app.site.clock.timekeeping import Timekeeper
from app.tracker.memory.memory import ClockSetting
from app.tracker.values.reason import Reason
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.fake_store import FakeReader
from tests.fakes import serving
from tests.golden.table import ClockRow, clocks
from tests.site.plant import make_plant
from tests.web.test_clocks import NOON

ROWS = pytest.mark.parametrize("row", clocks("set_shown"), ids=lambda row: f"{row.stored} {row.asked}")
CLOCK = "/api/v1/site/clock"


@ROWS
async def test_the_panel_of_a_running_site_agrees_with_its_controller(tmp_path: Path, row: ClockRow) -> None:
    plant = make_plant(start=NOON + row.stored)
    clock = plant.clock
    plant.site.model.timekeeper = Timekeeper(clock, ClockSetting("system"), drift=clock.drift)
    await plant.start()
    settings = Settings(data_dir=tmp_path)
    app = create_app(settings, machine=plant.site, reader=FakeReader(), clock=clock, hasher=FakeHasher())
    async with serving(app) as client:
        await plant.forward(seconds=2)
        clock.set_system(NOON + row.asked)
        await plant.forward(seconds=2)
        right = clock.system_time()
        assert right == NOON + row.asked + timedelta(seconds=2)
        told = (await client.get(CLOCK)).json()
        page = (await client.get("/trackers/T1/commissioning/clock/shadow")).text
        assert timedelta() <= right - datetime.fromisoformat(told["at"]) <= timedelta(seconds=1)
        assert f'value="{right:%Y-%m-%d}"' in page
        wrong = (right + timedelta(minutes=2)).isoformat()
        refused = await client.put(CLOCK, json={"source": "system", "device_at": wrong})
        assert "is 2 min behind this device" in refused.json()["detail"]
    await plant.close()


@ROWS
async def test_in_safe_mode_the_site_follows_the_clock(tmp_path: Path, row: ClockRow) -> None:
    clock = VirtualClock(NOON + row.stored)
    positions, why = KeptPositions(tmp_path / "drives"), Reason("safe_mode", "The database is damaged.")
    site = _site(Settings(data_dir=tmp_path), clock, why, positions)  # type: ignore[arg-type]
    clock.set_system(NOON + row.asked)
    site.model.timekeeper.watch()
    assert site.model.now() == NOON + row.asked
    positions.close()
