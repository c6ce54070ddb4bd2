"""`heliopanel study`: the table on the screen, a weather file by its path, and what is refused."""

import subprocess
import sys
from pathlib import Path

import pytest

from tests.studies.files import epw

SAMSUN = ("--lat", "41.28", "--lon", "36.33", "--date", "2026-06-21", "--time-zone", "Europe/Istanbul")
CALL = "import sys; from app.cli import main; sys.exit(main())"


def study(*words: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", CALL, "study", *words], capture_output=True, text=True, timeout=60, check=False
    )


def test_a_day_is_printed_as_a_table_with_its_progress_beside() -> None:
    told = study(*SAMSUN, "--span", "day", "--step", "60", "--mode", "dual", "--strategy", "deadband")
    assert told.returncode == 0, told.stderr
    assert "2 of 2: dual, deadband" in told.stderr
    lines = told.stdout.splitlines()
    assert lines[0].startswith(
        "clear sky by Ineichen and Perez, Linke turbidity of the location, 1 day, every 60 min"
    )
    assert [line.split("  ")[0] for line in lines[3:]] == ["Fixed", "Dual-axis, deadband"]


def test_a_weather_file_is_read_from_its_path(tmp_path: Path) -> None:
    path = tmp_path / "Samsun.epw"
    path.write_bytes(epw())
    told = study(*SAMSUN, "--weather", str(path), "--mode", "azimuth", "--csv")
    assert told.returncode == 0, told.stderr
    rows = told.stdout.splitlines()
    assert rows[0].startswith("mode,strategy,insolation_kwhm2")
    assert rows[2].startswith("azimuth,continuous,")


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--step", "7"), "The step is one of 1, 2, 3"),
        (("--weather", "/nowhere/file.epw"), "No such file"),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(words: tuple[str, ...], sentence: str) -> None:
    told = study(*SAMSUN, *words)
    assert told.returncode == 2
    assert sentence in told.stderr
    assert "Traceback" not in told.stderr
