"""The pages of studies and step programs: forms that keep what was typed, pictures, files, and their keys."""

import csv
import re
from collections.abc import AsyncIterator
from datetime import UTC, date, datetime
from html import unescape
from io import StringIO
from pathlib import Path

import httpx
import pytest

from app.base.settings import Settings
from app.studies.compute import finished, work_out
from app.studies.folder import MOST_STUDIES, StudyFolder, StudyState, StudyStatus
from app.studies.light import clear_days
from app.studies.request import Span, StudyMode, StudyRequest, StudyStrategy
from app.studies.result import StudyResult
from app.sun.position import Location
from app.tracker.programs.step_table import from_table
from app.tracker.settings.config import Orientation
from app.tracker.settings.strategy import Stepped
from app.web.charts.heatmap import heat_map
from app.web.main import create_app
from tests.fakes import FakeMachine, FakeReader, serving
from tests.web.filled import filled, values_of

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
TYPED = {
    "date": "2026-06-21",
    "span": "day",
    "modes": ["dual"],
    "strategies": ["deadband"],
    "title": "Noon's <best>",
}
PLACE = {"latitude": "41.28", "longitude": "36.33"}
STUDY_ID = "20260621T120000-0a1b2c"


@pytest.fixture
async def client(machine: FakeMachine, tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    app = create_app(Settings(data_dir=tmp_path), machine=machine, reader=FakeReader(), clock=machine.clock)
    async with serving(app) as browser:
        yield browser


def request_of(span: Span, **more: object) -> StudyRequest:
    return StudyRequest(
        "Noon", Location(41.28, 36.33), "Europe/Istanbul", span, date(2026, 6, 21),
        (StudyMode.AZIMUTH, StudyMode.DUAL), (StudyStrategy.CONTINUOUS,),
        Orientation(180.0, 48.7), 60, **more,
    )  # fmt: skip


@pytest.fixture(scope="module")
def found() -> StudyResult:
    request = request_of(Span.TWELVE_DAYS)
    days = clear_days(request)
    return finished(request, days, work_out(request, days, lambda *_: None), 0.2)


def state(status: StudyStatus, study_id: str = STUDY_ID, **more: object) -> StudyState:
    return StudyState(study_id, "Noon", datetime(2026, 6, 21, 12, tzinfo=UTC), status, **more)


@pytest.fixture
def kept(tmp_path: Path, found: StudyResult) -> StudyFolder:
    folder = StudyFolder(tmp_path)
    folder.open(state(StudyStatus.DONE), request_of(Span.TWELVE_DAYS))
    folder.keep(STUDY_ID, found)
    return folder


async def test_what_was_typed_stays_and_every_fault_is_named(client: httpx.AsyncClient) -> None:
    sent = {**TYPED, **PLACE, "deadband": "wide", "step": "61"}
    answer = await client.post("/studies", data=await filled(client, "/studies", sent), headers=HTMX)
    assert answer.status_code == 422
    assert "Deadband: type a number" in answer.text
    assert "Step must be between 1 and 60" in answer.text
    assert 'value="wide"' in answer.text
    assert "Noon&#39;s &lt;best&gt;" in answer.text
    assert re.search(r'value="dual" checked', answer.text)
    assert not re.search(r'value="azimuth" checked', answer.text)


@pytest.mark.usefixtures("real_processes")
async def test_a_begun_study_opens_its_page_and_can_be_cancelled(client: httpx.AsyncClient) -> None:
    sent = {**TYPED, **PLACE, "span": "year", "step": "2"}
    begun = await client.post("/studies", data=await filled(client, "/studies", sent), headers=HTMX)
    address = begun.headers["hx-redirect"]
    page = (await client.get(address)).text
    assert "<progress" in page
    assert "data-print" not in page
    assert '<button class="key">Cancel</button>' in (await client.get(address, headers=HTMX)).text
    assert 'hx-trigger="every 1s"' in page
    assert 'hx-trigger="every 2s"' in (await client.get("/studies")).text
    assert "<form" not in (await client.get("/studies/list", headers=HTMX)).text
    gone = await client.post(f"{address}/remove")
    assert gone.headers["location"] == address
    assert "was canceled before completion" in (await client.get(address)).text
    assert (await client.post(f"{address}/remove")).headers["location"] == "/studies"
    assert (await client.get(address)).status_code == 404


async def test_a_result_has_table_pictures_and_files(client: httpx.AsyncClient, kept: StudyFolder) -> None:
    text = (await client.get(f"/studies/{STUDY_ID}")).text
    assert text.count("<h1") == 1
    for name in ("Irradiance in the panel plane", "Panel orientation", "Electric energy of each month",
                 "In the panel plane, Dual-axis, continuous"):  # fmt: skip
        assert name in text
    for unit in ("W/m²", "kWh", "degrees", "hour of the day, standard time (UTC+3)", "month"):
        assert unit in text
    assert not re.search(r"\sstyle=|<style|\son[a-z]+=", text)
    assert "41.2800° north, 36.3300° east" in text
    assert "Ineichen and Perez, Linke turbidity of the location; sky model Hay and Davies" in text
    assert 'aria-current="true"><td><a href="/studies/20260621T120000-0a1b2c?case=2">Dual-axis' in text
    december = (await client.get(f"/studies/{STUDY_ID}?case=1&day=11")).text
    assert "10 December 2026" in december
    assert "Panel orientation, Azimuth, continuous" in december
    table = await client.get(f"/studies/{STUDY_ID}/table.csv")
    assert len(table.text.splitlines()) == 4
    curves = await client.get(f"/studies/{STUDY_ID}/curves.csv")
    assert len(curves.text.splitlines()) == 1 + 3 * 12 * 24
    assert "Noon" in (await client.get("/studies")).text


def test_only_the_newest_hundred_studies_stay(tmp_path: Path) -> None:
    folder = StudyFolder(tmp_path)
    for number in range(MOST_STUDIES + 3):
        folder.open(state(StudyStatus.DONE, f"20260621T{number:06}-0a1b2c"), request_of(Span.DAY))
    kept = folder.states(())
    assert (len(kept), kept[0].study_id) == (MOST_STUDIES, "20260621T000102-0a1b2c")


async def test_step_programs_are_shown_and_used(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    asked = {
        "date": "2026-06-21",
        "latitude": "45.65",
        "longitude": "25.6",
        "window": "yes",
        "move": "0.5",
        "degree": "0",
    }
    first = await client.get("/studies/program")
    assert 'hx-trigger="load"' in first.text
    bookmarked = await client.get("/studies/program", params=asked)
    assert "longitude=25.6" in bookmarked.text[bookmarked.text.index('hx-trigger="load"') - 400 :]
    assert "Best net energy" not in bookmarked.text
    answer = await client.get("/studies/program", params={**asked, "chosen": "8"}, headers=HTMX)
    assert answer.status_code == 200
    assert "The program of 8 steps" in answer.text
    assert "1932.62" in answer.text
    assert "Best net energy: 10 steps" in answer.text
    assert "−0.00" not in answer.text
    await check_files(client, answer.text)
    use = values_of(answer.text, "/studies/program/use")
    used = await client.post("/studies/program/use", data=use, headers=HTMX)
    assert "T1 now follows the program of 8 steps." in used.text
    strategy = machine.trackers["T1"].config.strategy
    assert isinstance(strategy, Stepped)
    wrong = await client.get("/studies/program", params={**asked, "range": "500", "tilt": "x"}, headers=HTMX)
    assert wrong.status_code == 422
    assert "Range must be between 5 and 120" in wrong.text
    assert 'value="500"' in wrong.text


async def check_files(client: httpx.AsyncClient, shown: str) -> None:
    """The page's two files have its table, and the chosen program as a tracker's strategy reads it."""
    table, program = re.findall(r'href="(/studies/program/[a-z]+\.csv\?[^"]+)"', shown)
    lines = list(csv.DictReader(StringIO((await client.get(unescape(table))).text)))
    assert [int(line["steps"]) for line in lines] == list(range(13))
    assert f"{float(lines[10]['electric_wh']):.2f}" in shown
    kept = await client.get(unescape(program))
    assert kept.headers["content-disposition"] == 'attachment; filename="program-8-steps-2026-06-21.csv"'
    assert len(from_table(kept.text).steps) == 9
    wrong = await client.get("/studies/program/table.csv", params={"date": "2026-06-21", "range": "500"})
    assert wrong.status_code == 422
    assert "Range must be between 5 and 120" in wrong.text


def test_a_heat_map_of_a_year_goes_by_weeks_and_leaves_the_night_out() -> None:
    days = [date.fromordinal(date(2026, 1, 1).toordinal() + number) for number in range(365)]
    noon = [[0] * 11 + [820, 1100] + [0] * 11] * 365
    shown = heat_map("T", days, noon)
    assert [one.number for one in shown.classes] == [6, 7]
    assert [one.path.count("M") for one in shown.classes] == [53, 53]
    assert [tick.text for tick in shown.columns][:2] == ["Jan", "Feb"]
    assert shown.across == "week of the year"


async def test_a_site_at_a_glance(client: httpx.AsyncClient, machine: FakeMachine) -> None:
    waiting = await client.get("/studies/glance")
    assert waiting.status_code == 200
    assert 'hx-trigger="load"' in waiting.text
    shown = await client.get("/studies/glance?ready=true", headers=HTMX)
    assert shown.status_code == 200
    for words in ("Modes in", "Deadbands, dual-axis", "Dual", "Greatest error"):
        assert words in shown.text
    told = (await client.get("/api/v1/studies/comparison?year=2026")).json()
    assert [row["mode"] for row in told["modes"]] == ["fixed", "azimuth", "elevation", "dual"]
    assert told["year"] == 2026
    assert told["deadbands"][0]["moves_a_day"] > told["deadbands"][-1]["moves_a_day"]
