"""What the machine and this computer did is told in the reader's language; what is stored stays as it is."""

from collections.abc import AsyncIterator
from datetime import UTC
from pathlib import Path

import pytest

from app.base.message import N_
from app.tracker.state.snapshot import EventKind
from app.tracker.values.actors import CONTROLLER
from app.web.features.records.record_words import value_of
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import TRANSLATED
from app.web.shell.formats import who
from tests.web.desk import Desk

PAGES = ("/journal", "/records", "/records/1", "/trackers/T1/record", "/api/v1/records/1?format=html")


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


async def happened(desk: Desk) -> None:
    """Let the machine do something by itself, and this computer sign a record."""
    site = desk.plant.site
    site.note(site.model.event(EventKind.CONTROLLER_RESTARTS, "Controller memory high.", CONTROLLER))
    await desk.forward(1.0)
    signed = {
        "signatures": [{"role": "technician", "name": "machine operator", "strokes": []}],
        "confirmed": True,
    }
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=signed)).status_code == 201


@pytest.mark.parametrize("code", TRANSLATED)
async def test_pages_tell_who_has_no_name_in_the_language_of_the_reader(code: str, desk: Desk) -> None:
    await happened(desk)
    for path in PAGES:
        page = (await desk.ask("GET", path, headers={"Cookie": f"language={code}"})).text
        assert ">local user<" not in page
        assert "by local user" not in page
        assert ">controller<" not in page
        assert "(controller)" not in page
    journal = (await desk.ask("GET", "/journal", headers={"Cookie": f"language={code}"})).text
    assert f">{catalogue_of(code).pgettext('record', 'controller')}<" in journal
    records = (await desk.ask("GET", "/records", headers={"Cookie": f"language={code}"})).text
    assert catalogue_of(code).said(N_("local user")) in records


async def test_files_keep_what_is_stored(desk: Desk) -> None:
    await happened(desk)
    answer = await desk.ask("GET", "/api/v1/journal", headers={"Cookie": "language=de"})
    assert CONTROLLER in {entry["event"]["actor"] for entry in answer.json()["items"]}


def test_a_printed_record_tells_who_did_it() -> None:
    before = CATALOGUE.set(catalogue_of("de"))
    try:
        assert said(value_of("by", CONTROLLER, UTC)) == "Steuerung"
        assert said(value_of("by", "machine", UTC)) == "Maschine", "as it was signed"
        assert said(value_of("by", "local user", UTC)) == "lokaler Benutzer"
        assert said(value_of("by", "Ada", UTC)) == "Ada"
        assert (who(CONTROLLER), who("machine"), who("machinist")) == ("Steuerung", "Steuerung", "machinist")
    finally:
        CATALOGUE.reset(before)
    assert said(value_of("by", "local user", UTC)) == "local user"
