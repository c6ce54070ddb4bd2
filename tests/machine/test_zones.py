"""A computer without the time zones of the world: Heliopanel starts, tracks by UTC inside, and shows UTC."""

from pathlib import Path

import httpx
import pytest

from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.tracker.memory.memory import SiteState
from tests.fault_result import FaultResult
from tests.machine.service import SAMSUN, Service
from tests.patience import eventually

WITHOUT_TZDATA = "import sys\nsys.modules['tzdata'] = None\n"


@pytest.fixture
def no_zones(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Have what is started now find neither the system's zones nor those of the package tzdata."""
    folder = tmp_path / "first"
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(WITHOUT_TZDATA)
    monkeypatch.setenv("PYTHONPATH", str(folder))
    monkeypatch.setenv("PYTHONTZPATH", "")


@pytest.fixture
def data_dir(tmp_path: Path) -> Path:
    """A site in Turkey, as it was stored when there were zones."""
    folder = tmp_path / "data"
    folder.mkdir(mode=0o700)
    url = f"sqlite:///{folder / 'heliopanel.db'}"
    upgrade(url)
    writer = open_writer(url)
    writer.save_site(SiteState(location=SAMSUN, time_zone="Europe/Istanbul"))
    writer.close()
    return folder


@pytest.mark.fault(30)
@pytest.mark.usefixtures("no_zones")
async def test_without_time_zones_it_starts_shows_utc_and_says_so(data_dir: Path, fault: FaultResult) -> None:
    service = await Service.start(data_dir)
    try:
        await service.until_served()
        await eventually(lambda: "zones_missing" in service.alarms())
        async with httpx.AsyncClient(base_url=f"http://127.0.0.1:{service.port}") as client:
            page = await client.get("/")
            assert page.status_code == 200
            assert "Time zones are missing" in page.text
            assert "UTC" in page.text
            assert "Europe/Istanbul" not in page.text
            kept = {"latitude_deg": 41.3, "longitude_deg": 36.3, "time_zone": "Europe/Istanbul"}
            refused = await client.put("/api/v1/site/location", json=kept)
            assert refused.status_code == 422
            assert "Install tzdata" in refused.text
        fault.prevented("noticed at the start; tracking needs no time zone")
        fault.shows("Time zones are missing")
        fault.recovers("tzdata is installed and the controller started again")
        assert len(service.starts("controller")) == 1
    finally:
        await service.stop()
