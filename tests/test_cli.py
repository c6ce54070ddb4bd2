"""The command line: what it prints, and how it says that something is wrong."""

import csv
import json
from dataclasses import asdict
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from app.base.build import VERSION
from app.cli import day as cli_day
from app.store.engine import open_reader, open_writer
from app.store.migrations import upgrade
from app.sun.position import Algorithm, Location, sun_position
from app.tracker.memory.memory import SiteState
from tests.command_line import Run, run

__all__ = ["run"]
SAMSUN = ["--lat", "41.2867", "--lon", "36.33"]


@pytest.mark.parametrize("algorithm", list(Algorithm))
def test_the_sun_as_json_has_full_precision(run: Run, algorithm: Algorithm) -> None:
    code, out, _ = run(
        "sun", *SAMSUN, "--at", "2026-06-21T12:00:00+03:00", "--algorithm", algorithm, "--json"
    )
    told = json.loads(out)
    expected = sun_position(algorithm, Location(41.2867, 36.33), datetime(2026, 6, 21, 9, tzinfo=UTC))
    assert code == 0
    assert told.items() >= asdict(expected).items()
    assert told["algorithm"] == algorithm.value
    assert (told["latitude_deg"], told["longitude_deg"]) == (41.2867, 36.33)
    assert datetime.fromisoformat(told["at"]) == datetime(2026, 6, 21, 9, tzinfo=UTC)


def test_accuracy_as_a_table_and_as_json(run: Run) -> None:
    years = ["--from", "2026", "--to", "2026", "--samples", "1000"]
    code, out, _ = run("accuracy", *SAMSUN, *years)
    assert code == 0
    assert "psa-plus" in out
    code, out, _ = run("accuracy", "--globe", *years, "--json")
    assert (code, json.loads(out)["location"]) == (0, None)
    code, _, err = run("accuracy", "--lat", "41.28")
    assert (code, "both --lat and --lon" in err) == (2, True)


def test_a_paper_as_text_and_as_json(run: Run) -> None:
    code, out, _ = run("papers", "--paper", "xia")
    assert code == 0
    assert "3 of 4 published figures come out." in out
    code, out, _ = run("papers", "--paper", "xia", "--markdown")
    assert (code, "## Xia et al. (2015)\n" in out) == (0, True)
    code, _, err = run("papers", "--paper", "none")
    assert (code, "choose one of" in err) == (2, True)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["sun", "--lat", "141", "--lon", "0"], "Latitude must lie between"),
        (["sun", *SAMSUN, "--at", "2026-06-21T12:00"], "has no time zone"),
        (["simulate", *SAMSUN, "--date", "2026-13-01", "--out", "x.csv"], "not a day of the calendar"),
        (["restore", "/nowhere/backup.db"], "/nowhere/backup.db"),
        (["drive-sim", "--tcp", "nowhere"], "HOST:PORT"),
    ],
)
def test_what_is_wrong_is_one_sentence(
    run: Run, words: list[str], sentence: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    code, out, err = run(*words)

    assert code == 2
    assert sentence in err
    assert "Traceback" not in err + out


def test_the_version_is_told(run: Run) -> None:
    assert run("version") == (0, f"{VERSION}\n", "")
    assert run("--version") == (0, f"Heliopanel {VERSION}\n", "")


def test_a_simulated_day_as_csv_and_parquet(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cli_day, "simulate_date", cache(cli_day.simulate_date))
    day = [*SAMSUN, "--date", "2026-06-21", "--time-zone", "Europe/Istanbul", "--step-s", "60"]
    table, columns = tmp_path / "day.csv", tmp_path / "day.parquet"

    assert run("simulate", *day, "--out", str(table))[0] == 0
    assert run("simulate", *day, "--out", str(columns))[0] == 0
    code, _, err = run("simulate", *day, "--out", str(tmp_path / "day.txt"))

    with table.open(encoding="utf-8", newline="") as file:
        assert len(list(csv.DictReader(file))) == 1441
    assert pq.read_table(columns).num_rows == 1441
    assert (code, "name it .csv or .parquet" in err) == (2, True)


def test_backup_and_restore_bring_a_site_back(
    run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    url = f"sqlite:///{tmp_path / 'heliopanel.db'}"
    upgrade(url)
    _name(url, "Samsun")
    assert run("backup", str(tmp_path / "kept.db"))[0] == 0
    _name(url, "Bafra")

    code, out, _ = run("restore", str(tmp_path / "kept.db"))

    reader = open_reader(url)
    restored = reader.site()
    reader.close()
    assert code == 0
    assert "Samsun" in out
    assert restored is not None
    assert restored.name == "Samsun"


def _name(url: str, name: str) -> None:
    writer = open_writer(url)
    writer.save_site(SiteState(name=name))
    writer.close()
