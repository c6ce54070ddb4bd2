"""What of a module, a template or a script reads like words for people."""

import pytest

from app.web.languages.extraction import texts
from app.web.languages.python_texts import python_texts
from app.web.languages.script_texts import script_texts, texts_of


@pytest.mark.parametrize(
    ("source", "found"),
    [
        ('raise Refused(f"{name} moves at {axis.speed:.1f} m/s.")', {"{name} moves at {speed} m/s."}),
        ('f"{a} of {b} of {a}"', {"{a} of {b} of {a2}"}),
        ("f\"{n} tracker{'s' if n > 1 else ''} at rest\"", {"{n} trackers at rest", "{n} tracker at rest"}),
        ('TITLES = {"north_side": "North side"}', {"North side"}),
        ('class Kind(StrEnum):\n    GOING_HOME = "going_home"', {"Going home"}),
        ('def f():\n    """Return a thing."""\n    log.info("a thing was done")', set()),
        ('if word == "not for people":\n    pass', set()),
        ('x = "SELECT name FROM users"', set()),
        ('x = "/trackers/some path"', set()),
        ('x = "M10 20 then 30"', set()),
    ],
)
def test_words_for_people_are_found(source: str, found: set[str]) -> None:
    assert {text for _, text in python_texts(source)} == found


def test_marked_texts_of_scripts_are_found() -> None:
    source = 'said(_("Mute 10 min"));\nwords.map((_, at) => at);\n_("He said \\"go\\".")'
    assert [text for _, text in texts_of(source)] == ["Mute 10 min", 'He said "go".']
    assert "Tracking" in script_texts()


def test_texts_come_from_templates_scripts_modules_and_documents() -> None:
    found = list(texts())
    assert {text.path.split("/")[0] for text in found} == {"templates", "static", "app", "docs"}
    assert any(text.many for text in found)
