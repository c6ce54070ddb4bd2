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


@pytest.mark.parametrize("unit", UNITS)
def test_both_use_the_same_user_data_and_settings(unit: str) -> None:
    lines = (DEPLOY / f"{unit}.service").read_text().splitlines()
    for line in (
        "User=heliopanel",
        "StateDirectory=heliopanel",
        "UMask=0077",
        "CapabilityBoundingSet=",
        "Environment=HELIOPANEL_DATA_DIR=/var/lib/heliopanel",
        "Environment=HELIOPANEL_CONFIG=/etc/heliopanel/heliopanel.toml",
        "RestartPreventExitStatus=2",
    ):
        assert line in lines


def test_serial_ports_are_the_controllers_alone() -> None:
    machine, web = ((DEPLOY / f"{unit}.service").read_text() for unit in UNITS)
    assert "SupplementaryGroups=dialout\n" in machine
    assert "DeviceAllow=char-tty* rw\n" in machine
    assert "PrivateDevices=yes\n" in web


def test_what_is_kept_in_memory_is_the_controllers_and_outlives_it() -> None:
    lines = (DEPLOY / "heliopanel-controller.service").read_text().splitlines()
    for line in ("RuntimeDirectory=heliopanel", "RuntimeDirectoryMode=0700", "RuntimeDirectoryPreserve=yes"):
        assert line in lines
