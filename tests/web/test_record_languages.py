"""A record is read in the reader's language: page, HTML and PDF; what was signed stays as it is."""

import hashlib
import io
import logging
import re
import zlib
from collections.abc import AsyncIterator, Iterator
from dataclasses import is_dataclass
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, get_args, get_type_hints

import httpx
import orjson
import pytest
from PIL import Image

from app.base.message import N_
from app.store.store import RecordHead, SignedRecord
from app.tracker.commissioning.steps import Step, StepStatus
from app.tracker.memory.memory import HomeTrust, Pointing, StepName
from app.tracker.settings.config import MountKind, TrackerConfig
from app.tracker.state.snapshot import ClockState
from app.tracker.values.motion import DriveCapabilities
from app.tracker.values.reason import Reason
from app.web.features.records.record import MISDATED
from app.web.features.records.record_document import read_document
from app.web.features.records.record_files import _step
from app.web.features.records.record_words import PARTS, label, value_of
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, TRANSLATED
from tests.amount import amount
from tests.web.desk import Desk

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


def test_a_line_is_called_by_the_fields_that_lead_to_it(turkish: None) -> None:
    name = label(("mount", "first", "joint_x_mm"))
    assert name == "mount first joint x mm"
    assert said(name).endswith(" (mm)")
    assert said(label(("deadband_deg",))) == "ölü bant (°)"


@pytest.mark.parametrize(
    ("field", "value", "english", "turkish_text"),
    [
        ("deadband_deg", 0.5, "0.5", "0,5"),
        ("set_at", AT, INSTANT, "21.06.2027 09:40:00 UTC+03:00"),
        ("kind", "encoder-deadband", "encoder-deadband", "kodlayıcı ölü bandı"),
        ("kind", MountKind.AZIMUTH_ELEVATION, "azimuth-elevation", "Azimut-yükseliş"),
        ("trusted", True, "yes", "evet"),
        ("set_at", None, "none", "yok"),
        ("name", "Stop", "Stop", "Stop"),
        ("remark", "Stop", "Stop", "Stop"),
        ("host", "Clock", "Clock", "Clock"),
        ("watchdog_action", "", "", ""),
        ("by", "Ayşe", "Ayşe", "Ayşe"),
    ],
)
def test_values_are_told_and_names_left_alone(
    field: str, value: object, english: str, turkish_text: str, turkish: None
) -> None:
    told = value_of(field, value, ISTANBUL)
    assert (told, said(told)) == (english, turkish_text)


def test_how_a_step_stands_is_told_with_who_confirmed_it_and_why_it_waits(turkish: None) -> None:
    why = (Reason("clock", N_("The clock has not been set.")),)
    _, told = _step(Step(StepName.CLOCK, StepStatus.DONE, why, AT, "Ayşe"), AT - timedelta(days=1), ISTANBUL)
    assert told == f"done, {INSTANT} by Ayşe. {MISDATED} The clock has not been set."
    assert said(told) == (
        "yapıldı, 21.06.2027 09:40:00 UTC+03:00, Ayşe. "
        "Tarih gelecekte, çünkü saat yanlıştı. Adımı yeniden onaylayın. Saat ayarlanmadı."
    )


def test_a_record_in_english_is_told_as_it_was_signed() -> None:
    assert said(label(("drive", "azimuth", "gear_ratio"))) == "drive azimuth gear ratio"
    assert said(value_of("set_at", AT, ISTANBUL)) == INSTANT


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


def streams(pdf: bytes) -> Iterator[str]:
    """Return what is drawn on each page."""
    for found in re.finditer(rb"stream\r?\n(.*?)\r?\nendstream", pdf, re.DOTALL):
        try:
            drawn = zlib.decompress(found[1])
        except zlib.error:
            continue
        if b" Tj" in drawn:
            yield drawn.decode("latin-1")


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


@pytest.mark.parametrize("code", amount(["tr", "zh_Hans"], ["en", "tr", "ro", "zh_Hans"]))
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
    pages = list(streams(pdf))
    assert len(pages) > 3
    assert [letters_without_font(page) for page in pages] == [0] * len(pages)
    assert CHINESE_FONT in pdf


@pytest.mark.parametrize(
    ("code", "is_there"),
    [("ro", False), ("zh_Hans", True), ("en", False), ("tr", False)][: amount(2, 4)],
)
async def test_the_second_font_comes_only_where_a_text_needs_it(
    code: str, is_there: bool, desk: Desk
) -> None:
    await sign(desk, name="Ștefan Müller")
    assert (CHINESE_FONT in (await read(desk, code, "pdf")).content) is is_there


async def test_two_records_are_compared_in_the_language_of_the_reader(desk: Desk) -> None:
    await sign(desk)
    assert (await desk.ask("PATCH", "/api/v1/trackers/T1", json={"deadband_deg": 0.75})).status_code == 200
    await sign(desk)
    page = await desk.ask("GET", "/records/compare?pick=1&pick=2", headers={"Cookie": "language=tr"})
    assert "<td>ölü bant (°)</td><td>0,5</td><td>0,75</td>" in page.text


@pytest.mark.parametrize(
    ("value", "written"), [(18251797.9, "18251797.9"), (-2e-06, "-0.000002"), (0.5, "0.5"), (360.0, "360")]
)
def test_numbers_are_written_without_powers_of_ten(value: float, written: str) -> None:
    assert value_of("value", value, UTC) == written
