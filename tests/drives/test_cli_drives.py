"""What the commands around lines refuse, as a person types them."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from app.cli import cli


def refused(*words: str) -> Exception:
    """Return why a command did nothing."""
    result = CliRunner().invoke(cli, words)
    assert isinstance(result.exception, ValueError | OSError), result.output
    return result.exception


@pytest.mark.parametrize(
    ("words", "why"),
    [
        (("near", "127.0.0.1:5020"), "choose --frames rtu"),
        (("127.0.0.1:5021", "127.0.0.1:5020", "--script", "explode"), "'explode' is no fault"),
        (("127.0.0.1:5021", "127.0.0.1:5020", "--script", "checksum"), "not possible with tcp frames"),
        ((":5021", "127.0.0.1:5020"), "Write it as HOST:PORT"),
    ],
)
def test_a_proxy_that_cannot_work_is_refused_with_what_to_do(words: tuple[str, str], why: str) -> None:
    assert why in str(refused("fault-proxy", *words))


def test_a_simulated_drive_takes_no_file_for_a_line(tmp_path: Path) -> None:
    name = tmp_path / "notes"
    name.write_text("mine")
    assert "not another file or device" in str(refused("drive-sim", "--rtu", str(name)))
    assert name.read_text() == "mine"


def test_a_simulated_drive_on_a_line_is_no_broadcast() -> None:
    assert "between 1 and 247" in str(refused("drive-sim", "--rtu", "line", "--unit", "0"))
