"""What cannot be released is refused, with the reason; `tests/soak/built/test_release.py` makes one."""

import os
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest

from release.__main__ import check, git
from release.bom import bill
from release.changelog import released
from release.refused import Refused

ROOT = Path(__file__).resolve().parents[3]
DAY = datetime(2030, 5, 17, tzinfo=UTC)
NEWS = "- The panel whistles."


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Return a small repository that could be released."""
    (tmp_path / "app" / "base").mkdir(parents=True)
    (tmp_path / "app" / "base" / "build.py").write_text('VERSION = "1.2.0"\n')
    (tmp_path / "CHANGELOG.md").write_text(f"# Changelog\n\n## [Unreleased]\n\n{NEWS}\n")
    git(tmp_path, "init", "--quiet")
    git(tmp_path, "config", "user.name", "Ada")
    git(tmp_path, "config", "user.email", "ada@localhost")
    git(tmp_path, "add", "--all")
    git(tmp_path, "commit", "--quiet", "-m", "before")
    return tmp_path


def test_a_bill_that_breaks_its_schema_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("release.bom.JsonV1Dot6.output_as_string", lambda *_, **__: '{"bomFormat": "no"}')
    with pytest.raises(Refused, match="does not follow its schema"):
        bill(ROOT, "1.3.0", DAY)


@pytest.mark.parametrize(
    ("version", "why"),
    [
        ("1.3", "is no version"),
        ("1.1.9", "older than the present version, 1.2.0"),
        ("v1.3.0", "is no version"),
    ],
)
def test_what_is_no_next_version_is_refused(copy: Path, version: str, why: str) -> None:
    check(copy, "1.2.0", copy / "dist")
    check(copy, "1.10.0", copy / "dist")
    with pytest.raises(Refused, match=why):
        check(copy, version, copy / "dist")


def test_what_is_not_ready_is_refused(copy: Path) -> None:
    (copy / "left").touch()
    with pytest.raises(Refused, match="not committed"):
        check(copy, "1.3.0", copy / "dist")
    (copy / "left").unlink()
    git(copy, "tag", "v1.3.0")
    with pytest.raises(Refused, match=r"released already: there is the tag v1\.3\.0"):
        check(copy, "1.3.0", copy / "dist")
    with pytest.raises(Refused, match="is there already"):
        check(copy, "1.4.0", copy / "app")


def test_a_text_that_a_language_does_not_have_is_refused(copy: Path) -> None:
    stored = copy / "app/web/locale/de/LC_MESSAGES/heliopanel.po"
    stored.parent.mkdir(parents=True)
    stored.write_text('msgid "Stop"\nmsgstr "Halt"\n\nmsgid "Save"\nmsgstr ""\n')
    git(copy, "add", "--all")
    git(copy, "commit", "--quiet", "-m", "a new text")
    with pytest.raises(Refused, match="does not translate 1 texts, first 'Save'"):
        check(copy, "1.3.0", copy / "dist")


def test_the_command_says_why_not(copy: Path) -> None:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "release", "1.1.0"]
    done = subprocess.run(command, cwd=copy, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "1.1.0 is older than the present version, 1.2.0.\n"


HEAD = "# Changelog\n\n## [Unreleased]\n"


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("# Changelog\n", "no heading"),
        (HEAD, r"tells nothing of 1\.3\.0"),
        (HEAD + "\n## [1.2.0] - 2026-01-01\n\n- Old.\n", r"tells nothing of 1\.3\.0"),
        (HEAD + "\n- More.\n\n## [1.3.0] - 2026-01-01\n\n- This.\n", "join them"),
        (HEAD + "\n## [1.3.0] - 2026-01-01\n\n## [1.2.0] - 2026-01-01\n\n- Old.\n", "is empty"),
    ],
)
def test_a_changelog_that_tells_nothing_or_twice_is_refused(text: str, why: str) -> None:
    with pytest.raises(Refused, match=why):
        released(text, "1.3.0", DAY.date())


def test_a_section_that_was_written_beforehand_stays() -> None:
    written = HEAD + "\n## [1.3.0] - 2026-01-01\n\n- This.\n"
    assert released(written, "1.3.0", DAY.date()) == written
