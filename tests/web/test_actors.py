"""What is told in the reader's language though nobody typed it: who did it, why a zero was lost, who may."""

from datetime import UTC

import pytest

from app.access.roles import who_may
from app.base.message import N_, say
from app.base.permission import Permission
from app.tracker.state.snapshot import EventKind
from app.tracker.values.actors import CONTROLLER
from app.web.features.records.record_words import value_of
from app.web.languages import CATALOGUE, said
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import TRANSLATED
from app.web.shell.formats import shown, who
from tests.web.desk import Desk

PAGES = ("/journal", "/records", "/records/1", "/trackers/T1/record", "/api/v1/records/1?format=html")
ENGLISH = (">local user<", "by local user", ">controller<", "(controller)")
LOST = say("The drive of {name} has restarted, so its home reference is lost.", name="T7")
SIGNED = {
    "signatures": [{"role": "technician", "name": "machine operator", "strokes": []}],
    "confirmed": True,
}


async def test_pages_tell_who_has_no_name_in_the_language_of_the_reader(desk: Desk) -> None:
    site = desk.plant.site
    site.note(site.model.event(EventKind.CONTROLLER_RESTARTS, "Controller memory high.", CONTROLLER))
    await desk.forward(1.0)
    assert (await desk.ask("POST", "/api/v1/trackers/T1/records", json=SIGNED)).status_code == 201
    for code in TRANSLATED:
        language = {"Cookie": f"language={code}"}
        told = {path: (await desk.ask("GET", path, headers=language)).text for path in PAGES}
        assert [path for path, page in told.items() if any(words in page for words in ENGLISH)] == [], code
        assert f">{catalogue_of(code).pgettext('record', 'controller')}<" in told["/journal"]
        assert catalogue_of(code).said(N_("local user")) in told["/records"]
    answer = await desk.ask("GET", "/api/v1/journal", headers={"Cookie": "language=de"})
    stored = {entry["event"]["actor"] for entry in answer.json()["items"]}
    assert CONTROLLER in stored, "what is stored stays as it is"


def test_only_who_has_no_name_is_told_in_the_language_of_the_page() -> None:
    before = CATALOGUE.set(catalogue_of("de"))
    try:
        assert said(value_of("by", CONTROLLER, UTC)) == "Steuerung"
        assert said(value_of("by", "machine", UTC)) == "Maschine", "as it was signed"
        assert said(value_of("by", "local user", UTC)) == "lokaler Benutzer"
        assert said(value_of("by", "Ada", UTC)) == "Ada"
        assert (who(CONTROLLER), who("machine"), who("machinist")) == ("Steuerung", "Steuerung", "machinist")
        assert (shown("local user", "who", "UTC"), shown("Open", "who", "UTC")) == (
            "lokaler Benutzer",
            "Open",
        )
        assert shown(-33.6, "horizon", "UTC") == "unter dem Horizont"
        assert shown(0.2, "horizon", "UTC") == "über dem Horizont"
    finally:
        CATALOGUE.reset(before)
    assert said(value_of("by", "local user", UTC)) == "local user"


@pytest.mark.parametrize("code", TRANSLATED)
def test_why_a_zero_was_lost_is_told_in_one_language(code: str) -> None:
    catalogue = catalogue_of(code)
    told = catalogue.said(say("{name} is not homed: {lost}", name="T7", lost=LOST))
    assert told.endswith(catalogue.said(LOST))
    assert catalogue.said(LOST) != LOST


def test_who_may_press_a_key_and_what_is_made_up_are_told_in_german() -> None:
    german = catalogue_of("de")
    needed = say("Only for {needed}.", needed=who_may(Permission.OPERATE))
    assert german.said(needed) == "Nur für Bediener oder Ingenieur."
    made_up = say("{text} The reading is SIMULATED.", text=say("It protects against {what}.", what="wind"))
    assert german.said(made_up).endswith("SIMULIERT.")
    assert german.pgettext("key", "Open") == "Öffnen"
