"""What the program says is shown in another language; what others wrote stays what it is."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.base.message import N_, Word, join, say, with_format
from app.tracker.settings.axes import Axis
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import TRANSLATED
from tests.amount import amount
from tests.web.languages.made_up import catalogue

DRIVE = "The drive of {name} does not answer."
NAMES = ["Row 6 is stowed", "Stop", "Site", "Holding", "100 %", "{name}", "%(name)s", "{0}", "T1. T2"]


@pytest.mark.parametrize(
    ("english", "german"),
    [
        (N_("Azimuth"), "Azimut"),
        (Word("azimuth"), "Azimut"),
        (Axis.AZIMUTH, "Azimut"),
        (
            say("The wind at {name} is too strong: {good} m/s.", name="T7", good=with_format(18.2, ".1f")),
            "Der Wind bei T7 ist zu stark: 18,2 m/s.",
        ),
        (
            say("Stopped by a fault: {message}", message=say(DRIVE, name="T7")),
            "Durch eine Störung angehalten: Der Antrieb von T7 antwortet nicht.",
        ),
        (join(" and ", (Axis.AZIMUTH, Word("elevation"))), "Azimut und Höhe"),
        (join(" ", (N_("Time to stand."), N_("Holding"))), "Zeit zu stehen. Steht"),
        (N_("Holding") + ".", "Steht."),
    ],
)
def test_messages_and_words_are_shown_in_the_language(english: str, german: str) -> None:
    assert catalogue().said(english) == german


@pytest.mark.parametrize("text", ["Azimuth", "Holding", "The drive of T7 does not answer.", "1,000", ""])
def test_a_text_that_is_no_message_is_data_and_stays(text: str) -> None:
    assert catalogue().said(text) == text


def test_a_number_is_written_as_the_language_does() -> None:
    number = say("{a} to {b}", a=with_format(1000, ","), b=with_format(86400.5, ",.1f"))
    assert catalogue({"{a} to {b}": "{a} bis {b}"}).said(number) == "1\u202f000 bis 86\u202f400,5"


@pytest.mark.parametrize("code", TRANSLATED)
@pytest.mark.parametrize("name", NAMES)
def test_a_name_like_a_word_of_ours_stays_in_every_language(code: str, name: str) -> None:
    said = catalogue_of(code).said(say(DRIVE, name=name))
    assert said == catalogue_of(code).gettext(DRIVE).replace("{name}", name)
    assert said != DRIVE.replace("{name}", name)


@settings(max_examples=amount(10, 100))
@given(name=st.text(min_size=1, max_size=40), code=st.sampled_from(TRANSLATED))
def test_any_name_stays(name: str, code: str) -> None:
    assert name in catalogue_of(code).said(say(DRIVE, name=name))
