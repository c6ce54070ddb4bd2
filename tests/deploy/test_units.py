"""The units give the services what they need and little more, by systemd's own judgement."""

import re
import subprocess
from pathlib import Path

import pytest

DEPLOY = Path(__file__).resolve().parents[2] / "deploy"
UNITS = ("heliopanel-controller", "heliopanel-web")
MOST_EXPOSED = 3.0


@pytest.mark.parametrize("unit", UNITS)
def test_systemd_finds_little_exposed(unit: str) -> None:
    asked = ("systemd-analyze", "security", "--offline=true", "--no-pager")
    told = subprocess.run([*asked, DEPLOY / f"{unit}.service"], capture_output=True, text=True, check=True)
    assert not told.stderr, "systemd did not understand a line"
    level = re.search(r"Overall exposure level for \S+: ([\d.]+)", told.stdout)
    assert level
    assert float(level[1]) < MOST_EXPOSED


BOTH = {
    "User=heliopanel",
    "StateDirectory=heliopanel",
    "UMask=0077",
    "CapabilityBoundingSet=",
    "Environment=HELIOPANEL_DATA_DIR=/var/lib/heliopanel",
    "Environment=HELIOPANEL_CONFIG=/etc/heliopanel/heliopanel.toml",
    "RestartPreventExitStatus=2",
}
CONTROLLER = {
    "SupplementaryGroups=dialout",
    "DeviceAllow=char-tty* rw",
    "RuntimeDirectory=heliopanel",
    "RuntimeDirectoryMode=0700",
    "RuntimeDirectoryPreserve=yes",
}


def test_each_has_the_lines_that_others_rely_on() -> None:
    """Serial ports, and what is kept in memory and outlives its process, are the controller's alone."""
    controller, web = (set((DEPLOY / f"{unit}.service").read_text().splitlines()) for unit in UNITS)
    assert controller >= BOTH | CONTROLLER
    assert web >= BOTH | {"PrivateDevices=yes"}
    assert not web & CONTROLLER
