"""A message is its English text, and keeps the template and the values that it was made of."""

import copy
import pickle
from datetime import UTC, datetime

import orjson
import pytest
from pydantic import TypeAdapter

from app.base.message import (
    N_,
    Message,
    Word,
    encoded,
    join,
    message_of,
    parts_of,
    plain,
    say,
    told_by,
    with_format,
    with_parts,
)
from app.link.codec import Problem, ProblemKind, Refused, decode_telling, encode_telling
from app.tracker.settings.axes import Axis
from app.tracker.values.reason import Reason
from app.web.languages.catalogue import GAP, catalogue_of
from app.web.languages.known import TRANSLATED

AT = datetime(2026, 6, 21, 11, 30, tzinfo=UTC)
INNER = say("The drive of {name} does not answer.", name="Stop")
OUTER = say(
    "{name}: {why} {number} of {count}, {axis}, {at}.",
    name="Row 6",
    why=INNER,
    number=with_format(2.5, ".2f"),
    count=with_format(12000, ","),
    axis=Axis.AZIMUTH,
    at=with_format(AT, "%H:%M"),
)


def test_a_message_is_its_english_text() -> None:
    assert OUTER == "Row 6: The drive of Stop does not answer. 2.50 of 12,000, azimuth, 11:30."
    assert orjson.dumps({"message": OUTER}) == orjson.dumps({"message": str(OUTER)})
    assert type(str(OUTER)) is str


@pytest.mark.parametrize(
    "again",
    [copy.deepcopy, copy.copy, lambda one: pickle.loads(pickle.dumps(one))],  # noqa: S301 - our own
)
def test_a_copy_keeps_template_and_values(again) -> None:
    assert (again(INNER).template, again(INNER).values) == (INNER.template, {"name": "Stop"})


@pytest.mark.parametrize("code", TRANSLATED)
def test_plain_data_is_shown_in_every_language_as_the_message_itself(code: str) -> None:
    read = message_of(orjson.loads(orjson.dumps(encoded(OUTER))))
    german = catalogue_of(code)
    assert read == OUTER
    assert german.said(read) == german.said(OUTER)


@pytest.mark.parametrize("name", ["Row 6", "Stop", "{name}"])
@pytest.mark.parametrize("code", TRANSLATED)
def test_a_name_is_never_looked_up(code: str, name: str) -> None:
    said = catalogue_of(code).said(say("The drive of {name} does not answer.", name=name))
    assert said == catalogue_of(code).gettext("The drive of {name} does not answer.").replace("{name}", name)


def test_numbers_words_and_lists_are_written_as_the_language_does() -> None:
    german = catalogue_of("de")
    assert (
        german.said(say("{a} {b}", a=with_format(2.5, ".2f"), b=with_format(12000, ",")))
        == "2,50 12\u202f000"
    )
    assert german.said(join(" and ", (Axis.AZIMUTH, Word("elevation")))) == "Azimut und Elevation"
    assert german.said(N_("Holding") + " T1") == f"{german.gettext('Holding')} T1"


def test_what_an_error_says_keeps_its_values() -> None:
    assert told_by(ValueError(INNER)).values == {"name": "Stop"}
    assert told_by(KeyError("T1", "T2")) == "('T1', 'T2')"


def test_template_and_values_cross_the_link() -> None:
    problem = Problem(ProblemKind.REJECTED, OUTER, (Reason("why", INNER),))
    told = decode_telling(encode_telling(Refused(1, problem))[4:])
    assert isinstance(told, Refused)
    assert catalogue_of("de").said(told.problem.reasons[0].message) == catalogue_of("de").said(INNER)
    assert told.problem.message.values["name"] == "Row 6"


def test_a_message_in_the_place_of_a_plain_text_does_not_end_the_connection() -> None:
    problem = Problem(ProblemKind.REJECTED, plain("Not now."), (Reason(INNER, plain("Not now.")),))
    told = decode_telling(encode_telling(Refused(1, problem))[4:])
    assert isinstance(told, Refused)
    assert told.problem.reasons[0].code == str(INNER)


@pytest.mark.parametrize("told", [None, 3, {"text": "a"}, {"text": "a", "template": "a", "values": 3}])
def test_what_is_no_message_is_refused(told: object) -> None:
    with pytest.raises(ValueError):
        TypeAdapter(Message).validate_python(told)


@pytest.mark.parametrize("code", TRANSLATED)
def test_every_sentence_of_the_catalogue_keeps_its_values_in_every_language(code: str) -> None:
    catalogue = catalogue_of(code)
    templates = [text for text in catalogue.texts if isinstance(text, str) and GAP.search(text)]
    assert len(templates) > 500
    for template in templates:
        names = set(GAP.findall(template))
        said = catalogue.rendered(say(template, **{name: f"<{name}>" for name in names}))
        assert {name for name in names if f"<{name}>" in said} == names, (template, said)
        assert not GAP.search(said), said


def test_parts_are_kept_beside_a_text_and_believed_only_if_they_say_the_same() -> None:
    refused = say("refused: {error}", error=say("{name} is busy.", name="T1"))
    parts = parts_of(refused)
    kept = with_parts(str(refused), parts)
    assert isinstance(kept, Message)
    assert (kept.template, kept.values) == (refused.template, refused.values)
    assert not isinstance(with_parts("refused: no.", parts), Message)
    assert parts is not None
    forged = parts.replace('"name": "T1"', '"name": "T2"')
    assert with_parts(str(refused), forged) == str(refused)
    assert (parts_of("done"), parts_of(N_("Stopped"))) == (None, None)
