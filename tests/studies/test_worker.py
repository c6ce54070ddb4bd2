"""The process that works studies out."""

import subprocess
import sys
from pathlib import Path

from app.studies.jobs import JOB, CheckWeather
from tests.patience import PATIENCE_S


def test_it_ends_quietly_when_nobody_listens_any_more(tmp_path: Path) -> None:
    command = (sys.executable, "-m", "app.studies.worker")
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=pipe) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        process.stdin.write(JOB.dump_json(CheckWeather(str(tmp_path / "none.epw"))) + b"\n")
        process.stdin.close()
        said = process.stderr.read()
        assert process.wait(PATIENCE_S) == 0
    assert said == b""
