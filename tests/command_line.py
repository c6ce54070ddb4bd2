"""The command line called in this process."""

import os
import sys
from collections.abc import Callable

import pytest

from app.cli import main

Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Return a call that runs the command line and returns its exit code, output and errors.

    What options put into the environment is taken out again; what is for tests alone is no setting.
    """
    environ = os.environ.copy()
    for name in [name for name in environ if name.startswith("HELIOPANEL_TEST_")]:
        del environ[name]
    monkeypatch.setattr(os, "environ", environ)

    def call(*words: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["heliopanel", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        told = capsys.readouterr()
        return int(ended.value.code or 0), told.out, told.err

    return call
