"""Profiles by name: those that ship and the engineer's own, and no way out of the two folders."""

from dataclasses import replace
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.drives.profile import PROFILES, ProfileError, known_profiles
from app.drives.profile_library import ProfileLibrary
from app.machine.drive_factory import DriveFactory
from app.tracker.settings.config import DriveConfig, DriveKind
from tests.drives.rigs import CONFIG, START

TEXT = (PROFILES / "simulated-plc.toml").read_text(encoding="utf-8")


def own(folder: Path, name: str, title: str = "Mine") -> None:
    text = TEXT.replace('"simulated-plc"', f'"{name}"').replace("Simulated PLC with two axes", title)
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")


def test_ones_own_profile_is_found_beside_the_shipped_ones(tmp_path: Path) -> None:
    own(tmp_path, "mine")
    library = ProfileLibrary(tmp_path)
    assert library.names() == tuple(sorted((*known_profiles(), "mine")))
    assert library.load("mine").title == "Mine"


def test_a_changed_profile_is_read_again(tmp_path: Path) -> None:
    library = ProfileLibrary(tmp_path)
    own(tmp_path, "mine")
    assert library.load("mine").title == "Mine"
    own(tmp_path, "mine", "Mine, another edition")
    assert library.load("mine").title == "Mine, another edition"


def test_a_shipped_profile_cannot_be_replaced(tmp_path: Path) -> None:
    own(tmp_path, "simulated-plc", "Not the real one")
    assert ProfileLibrary(tmp_path).load("simulated-plc").title == "Simulated PLC with two axes"


@pytest.mark.parametrize("name", ["../secret", "/etc/secret", "mine.toml", "Mine", "a\0b", "", "nonsense"])
def test_a_name_leads_nowhere_else(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "profiles"
    folder.mkdir()
    own(tmp_path, "secret")
    own(folder, "mine")
    with pytest.raises(ProfileError, match=r"There is no drive profile .* simulated-plc, .*profiles"):
        ProfileLibrary(folder).load(name)


def test_a_tracker_cannot_be_given_a_file_elsewhere(tmp_path: Path) -> None:
    own(tmp_path, "secret")
    drive = DriveConfig(DriveKind.MODBUS_TCP, str(tmp_path / "secret.toml"))
    with pytest.raises(ProfileError, match="no drive profile"):
        DriveFactory(VirtualClock(START), tmp_path / "data").make(replace(CONFIG, drive=drive))


def test_two_drives_of_one_axis_need_two_unit_ids() -> None:
    drive = DriveConfig(DriveKind.MODBUS_TCP, "kinco-cia402", unit=4)
    with pytest.raises(ProfileError, match=r"Both axes have unit 4.*a different unit id"):
        DriveFactory(VirtualClock(START)).make(replace(CONFIG, drive=drive))
