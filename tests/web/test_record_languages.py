"""A record is read in the reader's language: page, HTML and PDF; what was signed stays as it is."""

import io
import logging
import re
import zlib
from collections.abc import AsyncIterator, Iterator
from dataclasses import is_dataclass
from datetime import UTC
from pathlib import Path
from typing import Any, get_args, get_type_hints

import httpx
import pytest
from PIL import Image

from app.tracker.config import TrackerConfig
from app.tracker.memory import HomeTrust, Pointing
from app.tracker.motion import DriveCapabilities
from app.tracker.snapshot import ClockState
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES, TRANSLATED
from app.web.record import MISDATED
from app.web.record_files import _label, _text
from app.web.record_words import told_name, told_value
from tests.web.desk import Desk

CHINESE_FONT = b"DroidSansFallback"
INSTANT = "2027-06-21 09:40:00+03:00"


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


def labels(kind: Any, *path: str) -> Iterator[str]:
    """Return the name of every line that a part of a record can have."""
    for name, hint in get_type_hints(kind).items():
        options = (hint, *get_args(hint))
        inner = [one for one in options if is_dataclass(one)]
        if not any(getattr(one, "__origin__", None) is tuple for one in options):
            for one in inner:
                yield from labels(one, *path, name)
        if not inner or len(inner) < len(get_args(hint)):
            yield _label(" ".join((*path, name)))


@pytest.mark.parametrize("kind", [ClockState, HomeTrust, TrackerConfig, DriveCapabilities, Pointing])
def test_every_line_of_a_record_has_a_name_in_every_language(kind: Any, turkish: None) -> None:
    found = list(labels(kind))
    assert len(found) > 3
    for name in found:
        words = told_name(name).split(" (")[0].split(" · ")
        known = {catalogue_of("tr").pgettext("record", " ".join(part)) for part in splits(name)}
        assert set(words) <= known, name


def splits(name: str) -> Iterator[list[str]]:
    """Return every stretch of the words of a line's name."""
    words = re.sub(r" \(.*| (mm|h|v)$", "", name).split()
    words = words[:-1] if words[-1] in ("mm", "h", "v") else words
    for first in range(len(words)):
        for end in range(first + 1, len(words) + 1):
            yield words[first:end]


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("deadband (°)", "0.5", "0,5"),
        ("set at", INSTANT, "21.06.2027 09:40:00 UTC+03:00"),
        ("location", f"done, {INSTANT} by Ayşe.", "yapıldı, 21.06.2027 09:40:00 UTC+03:00, Ayşe."),
        (
            "clock",
            f"done, {INSTANT} by Ayşe. {MISDATED} The clock has not been set.",
            "yapıldı, 21.06.2027 09:40:00 UTC+03:00, Ayşe. "
            "Gelecekte: saat o zaman yanlıştı. Adımı yeniden onaylayın. Saat ayarlanmadı.",
        ),
        ("clock", "to do. The clock has not been set.", "yapılacak. Saat ayarlanmadı."),
        ("strategy kind", "encoder-deadband", "kodlayıcı ölü bandı"),
        ("mount kind", "azimuth-elevation", "Azimut-yükseliş"),
        ("watchdog", "0.5 s, read back", "0,5 s, geri okundu"),
        ("name", "Stop", "Stop"),
        ("remark", "Stop", "Stop"),
        ("drive host", "Clock", "Clock"),
        ("watchdog action", "", ""),
    ],
)
def test_values_are_told_and_names_left_alone(name: str, value: str, told: str, turkish: None) -> None:
    assert told_value(name, value) == told


def test_a_run_that_waits_tells_every_step_it_waits_for(turkish: None) -> None:
    steps = (
        "Step 1, location, is to be done: The location has not been entered. "
        "Step 2, clock, is to be done: The clock has not been set."
    )
    assert told_value("run", f"to do. {steps}") == (
        "yapılacak. Adım 1, Konum, yapılacak: Konum girilmedi. Adım 2, Saat, yapılacak: Saat ayarlanmadı."
    )


def test_a_record_in_english_is_told_as_it_was_signed() -> None:
    assert told_name("drive azimuth gear ratio") == "drive azimuth gear ratio"
    assert told_value("set at", INSTANT) == INSTANT


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


@pytest.mark.parametrize("code", ["en", "tr", "ro", "zh_Hans"])
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
    ("code", "is_there"), [("en", False), ("tr", False), ("ro", False), ("zh_Hans", True)]
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
    assert _text(value, UTC) == written
