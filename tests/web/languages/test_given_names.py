"""Names that people gave are values: whatever they are, in no language are they looked up or translated."""

from collections.abc import Iterator
from dataclasses import replace

import httpx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.tracker.reason import Reason
from app.web.languages.catalogue import catalogue_of
from app.web.languages.given_names import GIVEN
from app.web.languages.known import ENGLISH, LANGUAGES
from tests.fakes import FakeMachine

CODES = [code for code, language in LANGUAGES.items() if language is not ENGLISH]
HOSTILE = [
    "Row 6", "Row 6 is stowed", "Stop", "North", "Site", "Tracker 1", "Holding", "A", "the", "100 %",
    "{name}", "%(name)s", "{0}", "Azimuth and elevation", "Press Stop", "Wind: calm", "T1. T2",
    "Zeile 6", "Qx", "ok",
]  # fmt: skip
SENTENCES = [
    "{name} was stopped.",
    "{name} is stowed.",
    "The drive of {name} does not answer.",
    "The axes of {name} are still moving.",
    "{name} is not homed.",
    "{name} has stopped with a fault: The drive of {name} does not answer.",
    "{name} begins to track.",
]


@pytest.fixture(autouse=True)
def nobody_known() -> Iterator[None]:
    GIVEN.forget()
    yield
    GIVEN.forget()


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_name_stays_in_every_sentence(code: str, name: str) -> None:
    GIVEN.know([name, "T1"])
    for sentence in SENTENCES:
        english = sentence.replace("{name}", name)
        said = catalogue_of(code).said(english)
        assert said.count(name) >= english.count(name) - sentence.replace("{name}", "").count(name), said
        assert name in said


@pytest.mark.parametrize("code", CODES)
def test_what_is_said_of_a_name_is_translated_all_the_same(code: str) -> None:
    GIVEN.know(["Row 6", "Stop"])
    catalogue = catalogue_of(code)
    for name in ("Row 6", "Stop", "Nobody's"):
        english = f"The drive of {name} does not answer."
        assert catalogue.said(english) != english
        assert name in catalogue.said(english)
    like = catalogue.said("The drive of T07 does not answer.")
    assert catalogue.said("The drive of Row 6 does not answer.") == like.replace("T07", "Row 6")


@pytest.mark.parametrize("code", CODES)
def test_a_name_like_a_word_of_ours_leaves_our_sentences_alone(code: str) -> None:
    catalogue = catalogue_of(code)
    before = catalogue.said("Wait until the tracker has arrived, or press Stop.")
    GIVEN.know(["Stop"])
    assert catalogue.said("Wait until the tracker has arrived, or press Stop.") == before


@given(
    name=st.text(min_size=1, max_size=40), code=st.sampled_from(CODES), sentence=st.sampled_from(SENTENCES)
)
def test_any_name_stays(name: str, code: str, sentence: str) -> None:
    GIVEN.forget()
    GIVEN.know([name])
    assert name in catalogue_of(code).said(sentence.replace("{name}", name))


async def test_a_refusal_in_german_names_the_tracker_as_it_is_called(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    tracker = machine.trackers["T1"]
    tracker.config = replace(tracker.config, name="Row 6")
    machine.rejects["park"] = (Reason("drive", "The drive of Row 6 does not answer.", ""),)
    machine.emit()
    await client.get("/trackers/T1")
    headers = {"HX-Request": "true", "Accept-Language": "de"}
    answer = await client.post("/trackers/T1/park", headers=headers)
    assert answer.status_code == 409
    assert "Der Antrieb von Row 6 antwortet nicht." in answer.text
