"""The checks of `make check` find what is planted."""

import ast
import subprocess
from pathlib import Path

import pytest

from checks.documents import faults_of
from checks.generated import alike
from checks.secrets import findings
from checks.texts import english_values, ruled_out

WORDS = ruled_out()


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("The Machine has stopped.", ["Machine"]),
        ("The doors of MQTT", ["door"]),
        ("machine-readable, outdoors, inpeople", []),
    ],
)
def test_a_word_that_is_ruled_out_is_found(text: str, found: list[str]) -> None:
    assert WORDS.findall(text) == found


@pytest.mark.parametrize(
    "source",
    [
        'say("{a} is open.", a="the door")',
        'say("{a} is open.{more}", a=name, more=f" Reason: {why}" if why else "")',
        'say("Sent by {parts}.", parts=" and by ".join(parts))',
        'more = "nobody" if who is None else who\n    say("{more} is here.", more=more)',
    ],
)
def test_english_words_among_values_are_found(source: str) -> None:
    assert list(english_values(ast.parse(f"def f():\n    {source}")))


def test_what_a_document_names_and_is_not_there_is_told(tmp_path: Path) -> None:
    document = tmp_path / "page.md"
    document.write_text(
        "`app/base/own.py:own_folder` `app/base/own.py:none` `app/none/` [a](none.md) [b](#c)"
    )
    assert list(faults_of(document)) == [
        "app/base/own.py has no none",
        "app/none/ does not exist",
        "the link to none.md leads nowhere",
    ]


def test_words_are_compared_to_the_letter_and_numbers_to_a_hundredth() -> None:
    assert alike("It is 1.000 m.", "It is 1.005 m.\n")
    assert not alike("It is 1.0 m.", "It is 1.1 m.")
    assert not alike("It is 1.0 m.", "It was 1.0 m.")


PLANTED = (
    "-----BEGIN EC " + "PRIVATE KEY-----",
    "password = " + '"correct-horse-battery"',
    "hp_" + "a1b2c3d4" * 6,
    "AKIA" + "IOSFODNN7EXAMPLE",
    "mqtts://user:" + "s3cretpw@broker.example",
)


def test_planted_secrets_are_found(tmp_path: Path) -> None:
    subprocess.run(["git", "init", "-q", str(tmp_path)], check=True)
    (tmp_path / "settings.txt").write_text("first\n" + "\n".join(PLANTED))
    subprocess.run(["git", "-C", str(tmp_path), "add", "settings.txt"], check=True)
    found = {(one.path, one.line) for one in findings(tmp_path)}
    assert found == {("settings.txt", line) for line in range(2, 2 + len(PLANTED))}
