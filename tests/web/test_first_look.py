"""What stopped people who saw the panel for the first time: above all English amid another language."""

import pytest

from app.access.roles import who_may
from app.base.message import say
from app.base.permission import Permission
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.shell.formats import shown

LOST = say("The drive of {name} has restarted, so its home reference is lost.", name="T7")


@pytest.mark.parametrize("code", ["tr", "de", "es", "ro", "zh_Hans"])
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


def test_only_who_has_no_name_is_told_in_the_language_of_the_page() -> None:
    before = CATALOGUE.set(catalogue_of("de"))
    try:
        assert shown("local user", "who", "UTC") == "lokaler Benutzer"
        assert shown("Open", "who", "UTC") == "Open"
        assert shown(-33.6, "horizon", "UTC") == "unter dem Horizont"
        assert shown(0.2, "horizon", "UTC") == "über dem Horizont"
    finally:
        CATALOGUE.reset(before)
