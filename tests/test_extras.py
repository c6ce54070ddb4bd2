"""What few need is an extra: without it everything else works, and a sentence has the command."""

import subprocess
import sys
import tomllib
from collections.abc import Callable
from html import unescape
from pathlib import Path

import pytest

from app.base import extras
from app.base.extras import LIBRARIES, ExtraMissing
from app.cli import day as cli_day
from app.store.connections import parse_url
from tests.command_line import Run, run
from tests.fakes import FakeMachine, fake_app, serving

__all__ = ["run"]
PROJECT = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text())["project"]
SAMSUN = ["--lat", "41.2867", "--lon", "36.33"]
HEAVY = ("fontTools", "fpdf", "h5py", "pandas", "psycopg", "pvlib", "pyarrow", "scipy")
LOADS_ALL = f"""
import sys
sys.modules.update(dict.fromkeys({HEAVY}))
from importlib import import_module
from app.cli import COMMANDS
for module in {{place.partition(":")[0] for place in COMMANDS.values()}}:
    import_module(module)
"""


@pytest.fixture
def lacks(monkeypatch: pytest.MonkeyPatch) -> Callable[[str], str]:
    """Return a call that takes an extra away and returns the end of the sentence about it."""

    def take_away(extra: str) -> str:
        monkeypatch.setattr(extras, "find_spec", lambda name: None if name == LIBRARIES[extra] else object())
        return f'Install it with: pip install "heliopanel[{extra}]".'

    return take_away


def test_every_extra_can_be_installed_by_the_name_that_is_told() -> None:
    offered = PROJECT["optional-dependencies"]
    assert LIBRARIES.keys() <= offered.keys()
    assert offered["all"] == [f"heliopanel[{','.join(sorted(LIBRARIES))}]"]


def test_panel_machine_and_every_command_load_without_extras() -> None:
    subprocess.run([sys.executable, "-c", LOADS_ALL], check=True)


async def test_calls_and_pages_without_their_extra_say_the_command(lacks: Callable[[str], str]) -> None:
    async with serving(fake_app(FakeMachine())) as browser:
        for path, extra in (
            ("/api/v1/trackers/T1/record?format=pdf", "pdf"),
            ("/api/v1/studies/comparison?year=2026", "studies"),
            ("/studies/glance?year=2026&ready=1", "studies"),
        ):
            sentence = lacks(extra)
            answer = await browser.get(path, headers={"Accept": "text/html"})
            told = unescape(answer.text).replace('\\"', '"')
            assert (answer.status_code, sentence in told) == (501, True), path


def test_a_recording_is_not_written_as_parquet(
    run: Run, lacks: Callable[[str], str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(cli_day, "simulate_date", lambda *_, **__: (None, None))
    sentence = lacks("parquet")
    day = [*SAMSUN, "--date", "2026-06-21", "--step-s", "60", "--out", str(tmp_path / "day.parquet")]
    code, _, err = run("simulate", *day)
    assert (code, err.endswith(f"{sentence}\n")) == (2, True)


def test_a_database_of_postgresql_is_not_opened(lacks: Callable[[str], str]) -> None:
    sentence = lacks("postgres")
    with pytest.raises(ExtraMissing) as missing:
        parse_url("postgresql+psycopg://me@/nowhere")
    assert str(missing.value).endswith(sentence)
