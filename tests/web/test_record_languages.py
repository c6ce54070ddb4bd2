"""A record is read in the reader's language: page, HTML and PDF; what was signed stays as it is."""

import hashlib
import io
import logging
import re
from collections.abc import AsyncIterator, Iterator
from dataclasses import is_dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, get_args, get_type_hints

import httpx
import orjson
import pytest
from PIL import Image

from app.store.store import RecordHead, SignedRecord
from app.tracker.memory.memory import HomeTrust, Pointing
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import ClockState
from app.tracker.values.motion import DriveCapabilities
from app.web.features.records.record_document import read_document
from app.web.features.records.record_words import PARTS, label, value_of
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, TRANSLATED
from tests.amount import amount
from tests.web.desk import Desk
from tests.web.pdf_words import _streams

CHINESE_FONT = b"DroidSansFallback"
INSTANT = "2027-06-21 09:40:00+03:00"
AT = datetime.fromisoformat(INSTANT)
ISTANBUL = AT.tzinfo or UTC
UNNAMED = {"code", "message", "hint", "corners", "first", "second", "from"}
"""Fields of what stands in a list, such as the corners of a region: a value of one line."""


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


@pytest.fixture
def turkish() -> Iterator[None]:
    before = CATALOGUE.set(catalogue_of("tr"))
    yield
    CATALOGUE.reset(before)


async def sign(desk: Desk, name: str = "Ayşe Yılmaz", **more: Any) -> None:
    signed = {"signatures": [{"role": "technician", "name": name, "strokes": []}], "confirmed": True} | more
    answer = await desk.ask("POST", "/api/v1/trackers/T1/records", json=signed)
    assert answer.status_code == 201, answer.text


async def read(desk: Desk, code: str, form: str) -> httpx.Response:
    headers = {"Cookie": f"language={code}"}
    answer = await desk.ask("GET", f"/api/v1/records/1?format={form}", headers=headers)
    assert answer.status_code == 200
    return answer


def fields_of(kind: Any) -> Iterator[str]:
    """Return the name of every field that a part of a record can have."""
    for name, hint in get_type_hints(kind).items():
        yield name
        for option in (hint, *get_args(hint)):
            for one in (option, *get_args(option)):
                if is_dataclass(one):
                    yield from fields_of(one)


@pytest.mark.parametrize("kind", [ClockState, HomeTrust, TrackerConfig, DriveCapabilities, Pointing])
def test_every_field_of_a_record_has_a_name_in_every_language(kind: Any) -> None:
    found = {str(part) for name in fields_of(kind) for part in label((name,)).values.values()}
    assert len(found) > 3
    assert found - PARTS == UNNAMED & found


@pytest.mark.parametrize(
    ("field", "value", "english", "turkish_text"),
    [
        ("deadband_deg", 0.5, "0.5", "0,5"),
        ("value", -2e-06, "-0.000002", "-0,000002"),
        ("set_at", AT, INSTANT, "21.06.2027 09:40:00 UTC+03:00"),
        ("kind", MountKind.AZIMUTH_ELEVATION, "azimuth-elevation", "Azimut-yükseliş"),
        ("trusted", True, "yes", "evet"),
        ("set_at", None, "none", "yok"),
        ("name", "Stop", "Stop", "Stop"),
        ("host", "Clock", "Clock", "Clock"),
    ],
)
def test_values_are_told_and_names_left_alone(
    field: str, value: object, english: str, turkish_text: str, turkish: None
) -> None:
    told = value_of(field, value, ISTANBUL)
    assert (told, said(told)) == (english, turkish_text)


async def test_a_record_that_was_signed_without_its_lines_stays_english(desk: Desk, turkish: None) -> None:
    await sign(desk)
    with_lines = orjson.loads((await read(desk, "en", "json")).content)
    assert with_lines.pop("lines")
    text = orjson.dumps(with_lines).decode()
    head = RecordHead(1, "T1", AT, "Ada", hashlib.sha256(text.encode()).hexdigest())
    former = read_document(SignedRecord(head, text))
    assert said(former.sections[3][1][0][1]) == former.sections[3][1][0][1]


async def test_what_was_signed_is_the_same_in_every_language(desk: Desk) -> None:
    await sign(desk)
    assert len({(await read(desk, code, "json")).content for code in LANGUAGES}) == 1


@pytest.mark.parametrize("code", TRANSLATED)
async def test_page_and_html_are_in_the_language_of_the_reader(code: str, desk: Desk) -> None:
    await sign(desk, remark="Frost")
    catalogue = catalogue_of(code)
    page = (await desk.ask("GET", "/records/1", headers={"Cookie": f"language={code}"})).text
    printed = await read(desk, code, "html")
    assert f"<html lang='{LANGUAGES[code].tag}'>" in printed.text
    assert "Accept-Language" in printed.headers["vary"]
    for words in ("Settings as left", "gear ratio", "not selected", "Mounting correction"):
        assert catalogue.pgettext("record", words) != words
        assert catalogue.pgettext("record", words) in page
        assert catalogue.pgettext("record", words) in printed.text
    assert (
        catalogue.pgettext(
            "record", "The JSON file, which was signed, is in English; this is a translation of it."
        )
        in printed.text
    )
    assert "Frost" in printed.text
    assert "to do" not in page + printed.text


def letters_without_font(drawn: str) -> int:
    """Return how often text is shown on a page while no font is chosen, as a viewer would read it."""
    missing, chosen, kept = 0, False, []
    for word in re.sub(r"\((?:\\.|[^\\)])*\)", "()", drawn, flags=re.DOTALL).split():
        match word:
            case "q":
                kept.append(chosen)
            case "Q":
                chosen = kept.pop()
            case "Tf":
                chosen = True
            case "Tj":
                missing += not chosen
    return missing


@pytest.mark.parametrize("code", amount(["zh_Hans"], ["en", "tr", "ro", "zh_Hans"]))
async def test_every_letter_is_printed(code: str, desk: Desk, caplog: pytest.LogCaptureFixture) -> None:
    small = io.BytesIO()
    Image.new("RGB", (64, 48), "teal").save(small, "JPEG")
    for caption in ("铭牌", "Type plate", "Tip plakası"):
        path, files = "/api/v1/trackers/T1/record/photos", {"photo": ("plate.jpg", small.getvalue())}
        assert (await desk.ask("POST", path, files=files, data={"caption": caption})).status_code == 201
    await sign(desk, name="李明")
    with caplog.at_level(logging.WARNING):
        pdf = (await read(desk, code, "pdf")).content
    assert "glyph" not in caplog.text
    pages = [one.decode("latin-1") for one in _streams(pdf) if b" Tj" in one]
    assert len(pages) > 3
    assert [letters_without_font(page) for page in pages] == [0] * len(pages)
    assert CHINESE_FONT in pdf
