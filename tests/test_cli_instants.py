"""Days and instants as the world types them, given to every command: taken, or refused in a sentence."""

from pathlib import Path

import pytest

from tests.command_line import Run, run
from tests.golden.table import rows

__all__ = ["run"]
SAMSUN = ["--lat", "41.2867", "--lon", "36.33", "--time-zone", "Asia/Tokyo"]
ROWS = rows("world/instants.csv")
DAYS = ["0001-01-01", "2100-01-01", "10000-01-01", "2026-02-30", "21.06.2026", ""]


@pytest.mark.parametrize("row", ROWS, ids=[row["text"] for row in ROWS])
def test_the_sun_is_told_at_an_instant_or_a_sentence(row: dict[str, str], run: Run) -> None:
    code, out, err = run("sun", *SAMSUN[:4], "--at", row["text"])
    assert (code, "azimuth" in out) == ((0, True) if row["taken"] == "yes" else (2, False))
    assert "Traceback" not in err
    assert "isoformat" not in err


@pytest.mark.parametrize("row", ROWS[::4], ids=[row["text"] for row in ROWS[::4]])
def test_the_audit_since_an_instant(
    row: dict[str, str], run: Run, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    code, out, err = run("audit", "verify", "--since", row["text"])
    assert code in (0, 1, 2)
    assert "Traceback" not in out + err
    assert "isoformat" not in err


@pytest.mark.parametrize(
    ("command", "day"), [*(("simulate", day) for day in DAYS), ("strategies", DAYS[0]), ("study", DAYS[0])]
)
def test_a_day_that_no_sun_is_known_for_is_one_sentence(
    command: str, day: str, run: Run, tmp_path: Path
) -> None:
    more = ["--out", str(tmp_path / "day.csv")] if command == "simulate" else []
    code, out, err = run(command, *SAMSUN, "--date", day, *more)
    assert code == 2
    assert "in the years 1901 to 2099" in err or "type it as 2026-06-21" in err
    assert "Traceback" not in out + err
