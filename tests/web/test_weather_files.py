"""Weather files as they are downloaded and saved again, and their names: taken, or refused in our words."""

import re
from collections.abc import AsyncIterator, Callable
from html import unescape
from pathlib import Path

import httpx
import pytest

from app.base.settings import Settings
from app.studies.folder import WeatherFileRefused, weather_name
from app.studies.weather import read_weather
from app.studies.weather_columns import WeatherRefused
from app.web.main import create_app
from tests.fakes import FakeMachine, FakeReader, serving
from tests.golden.table import rows
from tests.studies import files

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

ROWS = rows("world/weather_files.csv")
NAMES = rows("world/file_names.csv")
FILES = "/api/v1/weather-files"
HTMX = {"HX-Request": "true"}
MADE: dict[str, Callable[[], bytes]] = {
    "EPW": files.epw,
    "TMY3": files.tmy3,
    "PVGIS_TMY": files.pvgis_tmy,
    "PVGIS_HOURLY": files.pvgis_hourly,
}
HEAD_LINES = {"EPW": 8, "TMY3": 2, "PVGIS_TMY": 18}
CITIES = {"EPW": "Samsun", "TMY3": "SAMSUN", "PVGIS_HOURLY": "PVGIS-SARAH3"}
COLUMNS = {
    "EPW": {"temp_air": 6, "ghi": 13, "dni": 14, "dhi": 15, "wind_speed": 21},
    "TMY3": {"ghi": 2, "dni": 3, "dhi": 4},
}
LEAP = {
    "EPW": ("2021,2,28,", "2021,2,29,"),
    "TMY3": ("02/28/2021,", "02/29/2021,"),
    "PVGIS_TMY": ("20210228:", "20210229:"),
}
ENDS = {"": "\n", "crlf": "\r\n", "cr": "\r"}


def made(row: dict[str, str]) -> bytes:
    """Return the file of a row: a year made here, changed and saved as the row says."""
    text = changed(MADE[row["format"]]().decode().replace("\r\n", "\n"), row["format"], row["change"])
    encoding, _, ends = row["saved"].partition(" ")
    return text.replace("\n", ENDS[ends]).encode(encoding)


def changed(text: str, kind: str, change: str) -> str:
    match change.split(" "):
        case [""]:
            return text
        case ["city", name]:
            return text.replace(CITIES[kind], name, 1)
        case ["leap", "day"]:
            before, leap = LEAP[kind]
            day = [line for line in text.splitlines(keepends=True) if line.startswith(before)]
            return text.replace(day[-1], day[-1] + "".join(day).replace(before, leap), 1)
        case ["cut", "line", at]:
            lines = text.splitlines()
            lines[int(at) - 1] = ",".join(lines[int(at) - 1].split(",")[:3])
            return "\n".join(lines)
        case [column, value, span]:
            first, last = (int(hour) + HEAD_LINES[kind] for hour in span.split("-"))
            lines = text.splitlines()
            for hour in range(first, last + 1):
                cells = lines[hour].split(",")
                cells[COLUMNS[kind][column]] = value
                lines[hour] = ",".join(cells)
            return "\n".join(lines)
    raise ValueError(change)


def named(row: dict[str, str]) -> str:
    return f"{row['format']} {row['saved']} {row['change']}"


@pytest.fixture
async def client(machine: FakeMachine, tmp_path: Path) -> AsyncIterator[httpx.AsyncClient]:
    app = create_app(Settings(data_dir=tmp_path), machine=machine, reader=FakeReader(), clock=machine.clock)
    async with serving(app) as browser:
        yield browser


@pytest.mark.parametrize("row", ROWS, ids=named)
def test_a_file_is_read_or_refused_with_the_reason(tmp_path: Path, row: dict[str, str]) -> None:
    path = tmp_path / "file.csv"
    path.write_bytes(made(row))
    if row["refusal"]:
        with pytest.raises(WeatherRefused, match=re.escape(row["refusal"])):
            read_weather(path)
    else:
        found = read_weather(path)
        assert found.source == row["source_said"]
        assert found.location.latitude_deg == files.LATITUDE


GAP = next(row for row in ROWS if "interpolated" in row["source_said"])
WRONG = next(row for row in ROWS if row["refusal"])


async def test_api_and_page_take_a_file_or_say_why_not(client: httpx.AsyncClient) -> None:
    refused = await client.post(FILES, files={"file": ("file.csv", made(WRONG))})
    assert (refused.status_code, WRONG["refusal"] in refused.json()["detail"]) == (422, True)
    shown = await client.post("/studies/weather", files={"file": ("file.epw", made(WRONG))}, headers=HTMX)
    assert (shown.status_code, WRONG["refusal"] in unescape(shown.text)) == (422, True)
    assert "outcome-refused" in shown.text
    taken = await client.post(FILES, files={"file": ("file.csv", made(GAP))})
    assert taken.status_code == 201, taken.text
    assert (taken.json()["seen"]["filled_hours"], taken.json()["seen"]["has_leap_day"]) == (1, False)
    page = " ".join((await client.get("/studies")).text.split())
    assert " · interpolated hours: 1" in page


def test_a_gap_is_interpolated_over_the_end_of_the_year(tmp_path: Path) -> None:
    path = tmp_path / "file.epw"
    path.write_bytes(changed(files.epw().decode(), "EPW", "temp_air 99.9 8759-8759").encode())
    air = read_weather(path).air_degc
    assert air[-1] == pytest.approx((air[-2] + air[0]) / 2.0)


def test_a_gap_over_the_end_of_the_year_is_one_gap(tmp_path: Path) -> None:
    path = tmp_path / "file.epw"
    text = changed(files.epw().decode(), "EPW", "dni 9999 8758-8759")
    path.write_bytes(changed(text, "EPW", "dni 9999 0-1").encode())
    with pytest.raises(WeatherRefused, match="From hour 8759 of the file, 4 hours have no dni"):
        read_weather(path)


@pytest.mark.parametrize("row", NAMES, ids=lambda row: row["source"] or row["text"])
def test_a_file_has_its_name_or_is_refused(row: dict[str, str]) -> None:
    if row["kept"]:
        assert weather_name(row["text"].rpartition("\\")[2]) == row["kept"]
    else:
        with pytest.raises(WeatherFileRefused, match="Name the weather file with at most 120 letters"):
            weather_name(row["text"])


@pytest.mark.parametrize("name", ["100 % #1?.epw", "C:\\fakepath\\güneş 2020.epw"])
async def test_a_file_is_kept_under_its_name_used_and_deleted(client: httpx.AsyncClient, name: str) -> None:
    typed = name.rpartition("\\")[2]
    answer = await client.post(FILES, files={"file": (name, files.epw())})
    assert answer.json()["name"] == typed
    asked = {"date": "2026-06-21", "span": "day", "light": "weather-file", "weather_file": typed}
    assert (await client.post("/api/v1/studies", json=asked | {"step_min": 60})).status_code == 202
    page = (await client.get("/studies")).text
    assert typed in unescape(page)
    action = unescape(page).partition('action="/studies/weather/')[2].partition('"')[0]
    assert (await client.post(f"/studies/weather/{action}", headers=HTMX)).status_code in (200, 204)
    assert (await client.get(FILES)).json()["items"] == []


async def test_what_is_no_weather_file_is_refused_and_not_kept(
    client: httpx.AsyncClient, tmp_path: Path
) -> None:
    for name, content, sentence in (
        ("notes.csv", b"hello", "cannot read this weather file"),
        ("half.epw", files.epw()[:400_000], "hours; a whole year has 8760"),
        ("empty.epw", b"", "empty"),
        ("a" * 117 + ".epw", b"", "Name the weather file"),
        ("天" * 77 + ".epw" * 3, b"", "Name the weather file"),
        ("large.epw", b"x" * (8 * 1024 * 1024 + 1), "at most 8 megabytes"),
    ):
        answer = await client.post(FILES, files={"file": (name, content)})
        assert answer.status_code == 422, name
        assert sentence in answer.text
    huge = await client.post(FILES, files={"file": ("huge.epw", b"x" * 9_500_000)})
    assert huge.status_code == 413
    assert not [one for one in (tmp_path / "weather").glob("*") if one.is_file()]
