"""No page shows a text that no language can have: in a language of wide letters all but data has them."""

import re

import httpx
import pytest

from app.web.features.guide.guide import TITLES
from app.web.languages.catalogue import Catalogue
from tests.fakes import FakeMachine, FakeReader, fake_app, serving
from tests.web.pseudo import pseudo_catalogue, speaking, untranslated
from tests.web.route_table import ROUTES

FILLED = {
    "{tracker_id}": "T1",
    "{recording_id}": "show-1",
    "{step}": "run",
    "{number}": "1",
    "{study_id}": "none",
    "{show_id}": "none",
    "{document}": "glossary",
}
NO_PAGES = re.compile(
    r"/(api|guide/pictures|papers|components|backup|diagnostics|metrics|health|ready|manifest)\b|\.csv"
)
"""What is for programs or a file, and the pages that stay English."""

MORE = (
    "/search?q=wind",
    "/recordings/show-1?with=day-1",
    "/journal?tracker=T1",
    "/nothing",
    "/trackers/T9",
    *(f"/guide/{name}" for name in TITLES),
)
DATA = re.compile(
    r"Deutsch|A simulated$|A simulated(?= ,)|Summer solstice in minutes|broker\.example|Connection refused"
    r"|none|_SUNSPEC_SERIAL_PORT|drive_lost|drive_fault|home_lost|disk_full|certificate_invalid"
    r"|heliopanel tls init"
    r"|(GET|PATCH) /api/v|/trackers/( id mount|T)|/mounts|/mast"
    r"|Samsun solar field|T[12] (North|South) field|North field|Heliopanel( [\d.]+)?|UTC([+−]\d+)?"
    r"|simulated-plc|SunSpec( over Modbus (TCP|RTU))?|Modbus TCP|JSON|CSV|Parquet|https?(://\S+)?"
    r"|broker\.example:8883|psa|ada|operator|min|Simulated drive|Alexandru 2024, Table 3"
    r"|Summer solstice in 3 minutes( began\.)?|A simulated day( began\.)?|[A-Z][\w-]+/[\w/-]+"
    r"|time,wind_mps,snow_kg( [\d:,]+)*"
    r"|Step run is not done yet\.|[\d.,: ]+|\d+ h|T[12]|·|,|[NOSW]{1,3}"
)
"""Names that people gave, units, formats, time zones, citations, codes, commands, what the machine says."""


def pages() -> list[str]:
    """Return the address of every page, filled in for the fake machine."""
    found = []
    for route in ROUTES:
        method, _, path = route.partition(" ")
        for gap, value in FILLED.items():
            path = path.replace(gap, value)
        if method == "GET" and not NO_PAGES.search(path):
            found.append(path)
    return [*found, *MORE]


def left_over(page: str) -> set[str]:
    """Return what a page shows that is neither translated nor data."""
    return {text for text in untranslated(page) if re.search(r"[^\W\d_]{3,}", DATA.sub("", text))}


@pytest.fixture(scope="module")
def brackets() -> Catalogue:
    return pseudo_catalogue()


@pytest.fixture
async def answers(brackets: Catalogue) -> dict[str, httpx.Response]:
    app = speaking(fake_app(FakeMachine(), FakeReader()), brackets)
    async with serving(app) as client:
        found = {path: await client.get(path) for path in pages()}
    return {path: one for path, one in found.items() if "text/html" in one.headers.get("content-type", "")}


async def test_every_text_of_every_page_can_be_translated(answers: dict[str, httpx.Response]) -> None:
    assert len(answers) > 50
    assert sum("⟦" in answer.text for answer in answers.values()) == len(answers)
    found = {path: left for path, answer in answers.items() if (left := left_over(answer.text))}
    assert found == {}
