"""The backup that deploy/README.md describes, run as it stands there; only the data folder is a test's."""

import os
import re
import subprocess
from pathlib import Path

from app.store.backup.backup import inspect_backup
from app.store.migrations import upgrade
from app.store.tables import REVISION
from tests.e2e.product import COMMAND

README = (Path(__file__).resolve().parents[2] / "deploy/README.md").read_text()
DATA = "/var/lib/heliopanel"


def test_the_backup_command_of_the_readme_works_as_written(tmp_path: Path) -> None:
    found = re.search(r"## Back up and restore\s+```sh\n(.+?)```", README, re.DOTALL)
    assert found
    command = found[1]
    assert DATA in command
    data, tools = tmp_path / "data", tmp_path / "bin"
    upgrade(f"sqlite:///{data / 'heliopanel.db'}")
    tools.mkdir()
    for name, line in (("sudo", 'exec "$@"'), ("heliopanel", f'exec {COMMAND} "$@"')):
        (tools / name).write_text(f"#!/bin/sh\n{line}\n")
        (tools / name).chmod(0o755)
    environment = {"PATH": f"{tools}:{os.environ['PATH']}", "HELIOPANEL_DATA_DIR": str(data)}
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    subprocess.run(
        ["sh", "-c", command.replace(DATA, str(data))],
        cwd=elsewhere,
        env=environment,
        capture_output=True,
        check=True,
    )
    (kept,) = (data / "backups").glob("*.db")
    assert inspect_backup(kept).revision == REVISION
    assert list(elsewhere.iterdir()) == []
