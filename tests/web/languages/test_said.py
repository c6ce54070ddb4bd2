"""What the program says in English is found in another language: whole, by its pattern, or piece by piece."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.web.languages.catalogue import LONGEST, Catalogue, catalogue_of
from app.web.languages.patterns import pattern_of
from tests.web.languages.made_up import GERMAN, catalogue


@pytest.mark.parametrize(
    ("english", "german"),
    [
        ("Azimuth", "Azimut"),
        ("The wind at T7 is too strong: 18.2 m/s.", "Der Wind bei T7 ist zu stark: 18,2 m/s."),
        (
            "Stopped by a fault: The drive of T7 does not answer.",
            "Durch eine Störung angehalten: Der Antrieb von T7 antwortet nicht.",
        ),
        ("The azimuth axis is measured.", "Die Achse Azimut wird gemessen."),
        ("The azimuth axis of T7", "T7, Achse Azimut"),
        ("azimuth and elevation", "Azimut und Höhe"),
        ("T7 North field is busy with a show.", "T7 North field ist mit einer Vorführung beschäftigt."),
        (
            "The drive of T7 does not answer. Nothing moves. Nothing is recorded.",
            "Der Antrieb von T7 antwortet nicht. Nichts bewegt sich. Nichts wird aufgezeichnet.",
        ),
        ("Holding.", "Steht."),
        ("Time to stand. 1 to 45, usual 2.5.", "Zeit zu stehen. 1 bis 45, üblich 2,5."),
        ("0.5 to 12", "0,5 bis 12"),
        ("1,000 to 86,400", "1\u202f000 bis 86\u202f400"),
    ],
)
def test_a_sentence_is_found(english: str, german: str) -> None:
    assert catalogue().said(english) == german


@pytest.mark.parametrize(
    "unknown",
    ["Go to the page of the drive", "Ankara, Izmir", "", "192.168.1.20", "Version 1.2 of the panel"],
)
def test_what_is_not_known_stays_as_it_is(unknown: str) -> None:
    assert catalogue().said(unknown) == unknown


def test_of_a_long_list_and_of_many_sentences_nothing_is_left_out() -> None:
    trackers, notes = ", ".join(f"T{number}" for number in range(1, 101)), "Ok. " * 60
    assert catalogue().said(f"azimuth, {trackers}") == f"Azimut, {trackers}"
    assert catalogue().said(f"Time to stand. {notes}".strip()) == f"Zeit zu stehen. {notes}".strip()


def test_a_name_is_not_translated_as_if_it_were_a_word() -> None:
    assert (
        catalogue().said("The drive of Azimuth does not answer.")
        == "Der Antrieb von Azimuth antwortet nicht."
    )


def test_the_pattern_that_explains_most_wins() -> None:
    texts = {
        "The jog of {axis} ended: {why}": "Fahrt von {axis} beendet: {why}",
        "The {axis} axis has reached its limit switch.": "Die Achse {axis} hat ihren Endschalter erreicht.",
        "the axis has reached its limit switch.": "die Achse hat ihren Endschalter erreicht.",
        "The {what} is off.": "{what} ist aus.",
        "The drive of {name} is off.": "Der Antrieb von {name} ist aus.",
    }
    said = catalogue(texts).said
    assert said("The drive of T7 is off.") == "Der Antrieb von T7 ist aus."
    assert (
        said("The jog of T7 ended: the axis has reached its limit switch.")
        == "Fahrt von T7 beendet: die Achse hat ihren Endschalter erreicht."
    )


def test_english_says_what_it_is_told() -> None:
    english = catalogue_of("en")
    assert (
        english.said("The wind at T7 is too strong: 18.2 m/s.") == "The wind at T7 is too strong: 18.2 m/s."
    )
    assert english.ngettext("one key", "keys", 2) == "keys"


@given(st.lists(st.text(alphabet="abc .:,{}[]", min_size=1, max_size=12), min_size=2, max_size=4))
def test_what_was_put_into_a_pattern_comes_out_again(values: list[str]) -> None:
    names = [f"gap{number}" for number in range(len(values))]
    pattern = pattern_of(" quartz ".join(f"{{{name}}}" for name in names))
    assert pattern is not None
    assert dict(zip(names, values, strict=True)) in pattern.fillings(" quartz ".join(values))


@given(st.text(max_size=LONGEST + 10))
def test_no_text_is_refused(text: str) -> None:
    assert isinstance(_GERMAN.said(text), str)


_GERMAN: Catalogue = catalogue()


def test_a_sentence_within_a_sentence_is_said_whatever_it_is_about() -> None:
    texts = {
        "{title} at {where} (priority {priority}) {change}": "{title}, {where} ({priority}) {change}",
        "was raised: {alarm}": "entstand: {alarm}",
        "{name} is no longer homed: {why}": "{name} hat keinen sicheren Nullpunkt mehr: {why}",
        "The {config} does not follow its command.": "{config} folgt dem Befehl nicht.",
        "{axis} axis of {name}": "Achse {axis} von {name}",
        "Zero is lost": "Nullpunkt verloren",
        "azimuth": "Azimut",
    }
    assert catalogue(texts).said(
        "Zero is lost at T7 (priority 2) was raised: T7 is no longer homed: The azimuth axis of "
        "T7 does not follow its command."
    ) == (
        "Nullpunkt verloren, T7 (2) entstand: T7 hat keinen sicheren Nullpunkt mehr: "
        "Achse Azimut von T7 folgt dem Befehl nicht."
    )


def test_a_label_before_a_range_and_sentences_known_to_the_letter_are_said() -> None:
    texts = {
        "{meaning} {least} to {most}, usual {default}.": "{meaning} {least} bis {most}, üblich {default}.",
        "Single and polar axes": "Einzelne und polare Achsen",
        "The {what} {bad}; {reacts}.": "{what} {bad}; {reacts}.",
        "The higher wind counts.": "Der höhere Wind zählt.",
        "Compare the sensors; switch one off.": "Sensoren vergleichen; einen abschalten.",
    }
    said = catalogue(texts).said
    assert said("Single and polar axes. 5 to 180, usual 60.") == (
        "Einzelne und polare Achsen. 5 bis 180, üblich 60."
    )
    assert said("The higher wind counts. Compare the sensors; switch one off.") == (
        "Der höhere Wind zählt. Sensoren vergleichen; einen abschalten."
    )


def test_hostile_text_that_fits_hundreds_of_patterns_is_answered() -> None:
    """A search that tried every division of the text would not end within the life of a test."""
    many = catalogue(
        GERMAN | {f"The {{a}} of the {{b}} in the {{c}} number {n}": f"{{a}} {n}" for n in range(500)}
    )
    hostile = "the of in number The " * (LONGEST // 21)
    for place in range(20):
        assert many.said(f"{place}{hostile}"[:LONGEST])
    assert many.said("x" * (LONGEST + 1)) == "x" * (LONGEST + 1)


@pytest.mark.parametrize("language", ["de", "es", "ro", "tr", "zh_Hans"])
@pytest.mark.parametrize(
    "sentences",
    [
        "There is no connection to the drive at 127.0.0.1:1502 unit 1. The device at 127.0.0.1 "
        "answers, but nothing listens on port 1502. Check its power, cable, and address, and that "
        "its port uses Modbus TCP only.",
        "The drive of T1 does not answer. The drive at plc:502 unit 1 did not answer within 0.3 s (status). "
        "Check its power and cable, its unit id 1, and, on a serial line, the speed and parity.",
        "Heliopanel runs in safe mode: The database /data/heliopanel.db is damaged (table events). Restore "
        "a backup with: heliopanel restore FILE.",
    ],
)
def test_of_what_is_wrong_with_a_machine_no_sentence_stays_english(language: str, sentences: str) -> None:
    said = catalogue_of(language).said(sentences)
    for english in (" is ", " the ", " did ", " and ", "Check", "Nothing", "Restore"):
        assert english not in said.replace("heliopanel restore FILE", "")
