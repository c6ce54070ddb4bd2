"""`heliopanel study`: the table on the screen, a weather file by its path, and what is refused."""

from pathlib import Path

import pytest

from app.cli import study
from app.studies import worker
from app.studies.jobs import JOB
from tests.command_line import Run, run
from tests.studies.files import epw

__all__ = ["run"]
# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


@pytest.fixture
def no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the job done here: a process only imports for two seconds more."""
    monkeypatch.setattr(worker, "tell", lambda _: None)
    monkeypatch.setattr(study, "_told", lambda job: iter([worker._answer(JOB.dump_json(job))]))


SAMSUN = ("--lat", "41.28", "--lon", "36.33", "--date", "2026-06-21", "--time-zone", "Europe/Istanbul")


def test_a_day_is_printed_as_a_table_with_its_progress_beside(run: Run) -> None:
    code, out, err = run(
        "study", *SAMSUN, "--span", "day", "--step", "60", "--mode", "dual", "--strategy", "deadband"
    )
    assert code == 0, err
    assert "2 of 2: dual, deadband" in err
    lines = out.splitlines()
    assert lines[0].startswith(
        "clear sky by Ineichen and Perez, Linke turbidity of the location, 1 day, every 60 min"
    )
    assert [line.split("  ")[0] for line in lines[3:]] == ["Fixed", "Dual-axis, deadband"]


@pytest.mark.usefixtures("no_process")
def test_a_weather_file_is_read_from_its_path(run: Run, tmp_path: Path) -> None:
    path = tmp_path / "Samsun.epw"
    path.write_bytes(epw())
    code, out, err = run("study", *SAMSUN, "--weather", str(path), "--mode", "azimuth", "--csv")
    assert code == 0, err
    rows = out.splitlines()
    assert rows[0].startswith("mode,strategy,insolation_kwhm2")
    assert rows[2].startswith("azimuth,continuous,")


@pytest.mark.usefixtures("no_process")
@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--step", "7"), "The step is one of 1, 2, 3"),
        (
            ("--weather", "/nowhere/file.epw"),
            "The weather file file.epw cannot be read (No such file or directory). Check its path.",
        ),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(run: Run, words: tuple[str, ...], sentence: str) -> None:
    code, _, err = run("study", *SAMSUN, *words)
    assert code == 2
    assert sentence in err
    assert "Traceback" not in err
