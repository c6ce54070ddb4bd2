"""Settings, profiles, and traces as text editors save them: read, or refused with what to do."""

from pathlib import Path

import pytest

from app.drives.profile import PROFILES
from tests.command_line import Run, run
from tests.golden.table import rows
from tests.ports import free_port

__all__ = ["run"]

ROWS = rows("world/toml_files.csv")
TRACE = '{"at_s": 0.0, "unit": 1, "read": [0, 2], "reply": [1, 2]}\n'
ENDS = {"": "\n", "crlf": "\r\n", "cr": "\r"}


def saved(text: str, how: str) -> bytes:
    """Return a text as an editor saves it: in an encoding, with its line ends."""
    encoding, _, ends = how.partition(" ")
    return text.replace("\n", ENDS[ends]).encode(encoding)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: f"{row['entrance']} {row['saved']}")
def test_a_file_is_read_as_an_editor_saves_it(
    row: dict[str, str], run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    monkeypatch.setenv("HELIOPANEL_PORT", str(free_port()))
    code, out, err = ENTRANCES[row["entrance"]](run, tmp_path, row["saved"])
    if row["refusal"]:
        assert code != 0
        assert row["refusal"] in err
        assert "codec" not in err
        assert ".." not in err.replace("...", "")
        assert err.count("\n") == 1
    else:
        assert (code, err) == (0, ""), err
        assert out


def settings(run: Run, folder: Path, how: str) -> tuple[int, str, str]:
    file = folder / "settings.toml"
    file.write_bytes(saved("# Güneş\ntick_ms = 200\n", how))
    code, out, err = run("--config", str(file), "config", "check")
    return code, out if "tick_ms = 200\n" in out else "", err


def network(run: Run, folder: Path, how: str) -> tuple[int, str, str]:
    (folder / "network.toml").write_bytes(saved('# Güneş\nallowed_hosts = ["sun.example"]\n', how))
    code, out, err = run("config", "check")
    return code, out if "'sun.example'" in out else "", err


def profile(run: Run, folder: Path, how: str) -> tuple[int, str, str]:
    text = (PROFILES / "simulated-plc.toml").read_text(encoding="utf-8")
    file = folder / "own.toml"
    file.write_bytes(saved(f"# Güneş\n{text}", how))
    return run("drive", "check", str(file))


def trace(run: Run, folder: Path, how: str) -> tuple[int, str, str]:
    file = folder / "own.jsonl"
    file.write_bytes(saved(TRACE, how))
    code, out, err = run("drive", "replay", str(file))
    return (0, "read", "") if "Give --profile NAME" in err else (code, out, err)


ENTRANCES = {"settings": settings, "network": network, "profile": profile, "trace": trace}
