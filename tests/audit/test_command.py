"""`heliopanel audit` at the computer: what holds, what is broken, and what is taken along."""

import csv
import json
import sqlite3
from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from app.access.events import AccessEvent
from app.access.opening import open_store
from app.audit.entry import Entry
from app.base.settings import Settings
from app.cli import cli
from app.store.engine import open_writer
from app.store.migrations import upgrade

NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)
ENTRY = Entry(NOON, 1, "boot", "trusted", "=cmd|' /C calc'!A0", "session", "10.0.0.7", "stop", "T1", "{}")
Ask = Callable[..., Result]


@pytest.fixture
def ask(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Ask:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    settings = Settings()
    upgrade(settings.url)
    writer = open_writer(settings.url)
    for day in range(5):
        with writer.audited(replace(ENTRY, utc=NOON + timedelta(days=day), mono_ms=day)):
            pass
    writer.close()
    store = open_store(settings)
    with store.writing() as change:
        for action in ("add_user", "log_in"):
            change.note(AccessEvent(NOON, "ada", "console", "", action, "ada"))
    store.close()
    return lambda *words: CliRunner().invoke(cli, ["audit", *words])


def forge(path: Path, trigger: str, statement: str) -> None:
    """Change a database as somebody with the file in hand could."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute(f"DROP TRIGGER IF EXISTS {trigger}")
        connection.execute(statement)
        connection.commit()


def test_the_first_broken_entry_is_named(ask: Ask, tmp_path: Path) -> None:
    forge(tmp_path / "heliopanel.db", "audit_UPDATE_refused", "UPDATE audit SET actor = 'eve' WHERE seq = 3")
    told = ask("verify")
    assert told.exit_code == 1
    assert "The audit is broken at entry 3: its content was changed" in told.output
    assert ask("verify", "--since", "2027-06-24").exit_code == 0
    assert "no entry since then" in ask("verify", "--since", "2030-01-01").output


def test_a_removed_end_is_seen_by_a_head_that_was_logged(ask: Ask, tmp_path: Path) -> None:
    untouched = ask("verify").output
    assert "The audit holds: 5 entries" in untouched
    assert "The record of users and tokens holds: 2 entries, the last is 2:" in untouched
    head, access_head = (part.split(".")[0] for part in untouched.split("the last is ")[1:])
    assert ask("verify", "--head", head, "--access-head", access_head).exit_code == 0
    forge(tmp_path / "heliopanel.db", "audit_DELETE_refused", "DELETE FROM audit WHERE seq = 5")
    forge(
        tmp_path / "access.db", "access_events_DELETE_refused", "DELETE FROM access_events WHERE number = 2"
    )
    assert ask("verify").exit_code == 0
    for logged in (("--head", head), ("--access-head", access_head)):
        told = ask("verify", *logged)
        assert told.exit_code == 1
        assert "is not in the chain" in told.output


def test_the_record_of_users_is_checked_too(ask: Ask, tmp_path: Path) -> None:
    forge(
        tmp_path / "access.db",
        "access_events_UPDATE_refused",
        "UPDATE access_events SET actor = 'eve' WHERE number = 2",
    )
    told = ask("verify")
    assert told.exit_code == 1
    assert "The record of users and tokens is broken at entry 2" in told.output


def test_the_audit_is_taken_along(ask: Ask, tmp_path: Path) -> None:
    told = ask("export", str(tmp_path / "audit.csv"), "--since", "2027-06-22")
    assert told.exit_code == 0, told.output
    assert (tmp_path / "audit.csv").read_bytes().startswith(b"\xef\xbb\xbf"), "for Excel"
    with (tmp_path / "audit.csv").open(encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert [row["seq"] for row in rows] == ["2", "3", "4", "5"]
    assert rows[0]["actor"] == f"'{ENTRY.actor}"
    ask("export", str(tmp_path / "audit.json"), "--format", "json")
    lines = (tmp_path / "audit.json").read_text().splitlines()
    assert [json.loads(line)["seq"] for line in lines] == [1, 2, 3, 4, 5]
    assert json.loads(lines[0])["actor"] == ENTRY.actor
    ask("export", str(tmp_path / "access.json"), "--of", "access", "--format", "json")
    first, second = map(json.loads, (tmp_path / "access.json").read_text().splitlines())
    assert (first["action"], second["action"]) == ("add_user", "log_in")
    assert second["prev_hash"] == first["hash"]
    told = ask("export", str(tmp_path / "access.csv"), "--of", "access")
    assert "2 entries of the record of users and tokens are in" in told.output
    with (tmp_path / "access.csv").open(encoding="utf-8-sig") as file:
        assert [row["action"] for row in csv.DictReader(file)] == ["add_user", "log_in"]
    ask("export", str(tmp_path / "later.json"), "--of", "access", "--format", "json", "--since", "2030-01-01")
    assert (tmp_path / "later.json").read_text() == ""
