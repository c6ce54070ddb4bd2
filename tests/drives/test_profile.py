"""Profiles: what ships, one's own beside them, what the loader takes, and the sentences of its refusals."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

from app.base.clock import VirtualClock
from app.drives.connections.profile_needs import check_needs
from app.drives.dialects.gearing import Gearing, gearing_of
from app.drives.profile import (
    PROFILES,
    Adapter,
    ProfileError,
    SequenceStep,
    known_profiles,
    load_profile,
    parse_profile,
)
from app.drives.profile_library import ProfileLibrary
from app.drives.register import Register, ValueMisfit, WordOrder, WordType
from app.machine.drive_factory import DriveFactory
from app.simulation.profile_page import DOCS, renewed
from app.tracker.settings.config import AxisDrive, DriveConfig, DriveKind
from tests.drives.rigs import CONFIG, START
from tests.golden.table import rows

TEXT = (PROFILES / "simulated-plc.toml").read_text(encoding="utf-8")
WRONG = rows("wrong_profiles.csv")


@pytest.mark.parametrize("name", known_profiles())
def test_every_profile_that_ships_is_right_and_its_page_is_up_to_date(name: str) -> None:
    profile = load_profile(name)
    assert profile.name == name
    assert all(len(register.source) > 10 for register in profile.registers.values())
    assert profile.verified == (not profile.unverified)
    check_needs(profile)
    written = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    assert written == renewed(written, profile), "run python -m app.simulation.profile_page"


def test_the_example_on_the_page_is_a_right_profile_and_the_page_names_every_adapter() -> None:
    page = (DOCS / "writing-a-profile.md").read_text(encoding="utf-8")
    example = re.search(r"```toml\n(.*?)```", page, re.DOTALL)
    assert example is not None
    profile = parse_profile(example[1], "my-servo.toml")
    check_needs(profile)
    assert (profile.adapter, profile.registers["velocity"].optional) == (Adapter.CIA402, True)
    assert profile.watchdog is not None
    assert profile.watchdog.register is None
    assert set(profile.registers) - set(profile.unverified) == {"controlword"}
    assert all(f"| `{adapter}` |" in page for adapter in Adapter)


@pytest.mark.parametrize("row", WRONG, ids=[row["what"] for row in WRONG])
def test_a_wrong_profile_is_refused_with_its_file_and_the_rule(row: dict[str, str]) -> None:
    right, wrong = (row[name].replace(r"\n", "\n") for name in ("right", "wrong"))
    text = (PROFILES / f"{row['profile']}.toml").read_text(encoding="utf-8")
    assert right in text
    with pytest.raises(ProfileError, match=row["says"]) as caught:
        check_needs(parse_profile(text.replace(right, wrong, 1), "own.toml"))
    assert str(caught.value).startswith("own.toml")


def test_an_unknown_profile_is_answered_with_those_there_are_and_a_file_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(ProfileError, match=r"Choose one of .*simulated-plc"):
        load_profile("nonsense")
    own = tmp_path / "own.toml"
    own.write_bytes(TEXT.replace("Simulated PLC with", "Simulierte Antriebe für").encode("latin-1"))
    with pytest.raises(ProfileError, match=r"own\.toml, line \d+: this is not UTF-8"):
        load_profile(str(own))


def test_a_table_is_found_in_spite_of_its_comment() -> None:
    text = TEXT.replace("[bits.status]", "[bits.status]   # what moves").replace("homing = 4", "homing = 40")
    line = next(number for number, one in enumerate(text.splitlines(), 1) if one.startswith("homing = 40"))
    with pytest.raises(ProfileError, match=rf"line {line}, bits\.status\.homing: must lie between"):
        parse_profile(text, "own.toml")


def test_a_wide_register_has_32_bits_and_one_doubtful_line_makes_a_profile_unverified() -> None:
    text = (PROFILES / "kinco-cia402.toml").read_text(encoding="utf-8")
    text = text.replace("origin = 2", "origin = 2\nbrake = 31")
    assert parse_profile(text, "own.toml").bits["inputs"]["brake"] == 31
    text = TEXT.replace("heartbeat = { address = 2,", "heartbeat = { address = 2, verified = false,")
    assert not parse_profile(text, "own.toml").verified


PACKED = {
    "uint16": (Register("x", 7, WordType.UINT16), 40000.0, (40000,)),
    "int16": (Register("x", 7, WordType.INT16), -2.0, (0xFFFE,)),
    "int32": (Register("x", 7, WordType.INT32, scale=0.001), -102.4, (0xFFFE, 0x7000)),
    "low first": (
        Register("x", 7, WordType.INT32, WordOrder.LOW_FIRST, scale=0.001), -102.4, (0x7000, 0xFFFE)
    ),
    "uint32": (Register("x", 7, WordType.UINT32), 4000000000.0, (0xEE6B, 0x2800)),
    "turned": (Register("x", 7, WordType.INT16, scale=0.1, sign=-1), 12.3, (0xFF85,)),
}  # fmt: skip


@pytest.mark.parametrize("name", PACKED)
def test_values_are_packed_and_unpacked(name: str) -> None:
    register, value, words = PACKED[name]
    assert register.words(value) == words
    assert register.value([99, 99, *words], 5) == pytest.approx(value)


@pytest.mark.parametrize("value", [-1, 65536, float("1e12")])
def test_what_does_not_fit_is_refused(value: float) -> None:
    with pytest.raises(ValueMisfit, match="does not fit into register x"):
        Register("x", 7, WordType.UINT16).words(value)


def test_a_step_takes_a_word_or_a_number() -> None:
    sequences = load_profile("leadshine-rs").sequences
    assert sequences["reset_fault"] == (SequenceStep("control", 0x1111),)
    assert sequences["enable"] == (SequenceStep("enable", 1),)


def test_degrees_become_steps_by_revolution_gear_and_direction() -> None:
    profile = load_profile("leadshine-rs")
    gearing = gearing_of(profile, AxisDrive(gear_ratio=36.0))
    assert gearing == Gearing(10000.0, 36.0, 1)
    assert (gearing.steps(90.0), gearing.degrees(-1000.0)) == (90000, -1.0)
    turned = gearing_of(profile, AxisDrive(steps_per_revolution=3600.0, gear_ratio=10.0, inverted=True))
    assert (turned.steps(1.5), turned.degrees(100.0)) == (-150, -1.0)


def test_speeds_and_ramps_come_in_the_drives_units_and_the_slowest_is_not_zero() -> None:
    gearing = Gearing(10000.0, 36.0)
    assert gearing.speed(3.0, "rpm") == pytest.approx(18.0)
    assert gearing.speed(3.0, "steps/s") == pytest.approx(3000.0)
    assert gearing.velocity(-3.0, "rpm") == pytest.approx(-18.0)
    assert Gearing(10000.0, 36.0, -1).velocity_dps(18.0, "rpm") == pytest.approx(-3.0)
    assert gearing.ramp(6.0, "steps/s2") == pytest.approx(6000.0)
    assert gearing.ramp(6.0, "ms/1000rpm") == pytest.approx(1000.0 / 36.0 * 1000.0)
    assert (Gearing(200.0).speed(0.01, "rpm"), Gearing(200.0).speed(0.0, "rpm")) == (1.0, 0.0)


def own(folder: Path, name: str, title: str = "Mine") -> None:
    text = TEXT.replace('"simulated-plc"', f'"{name}"').replace("Simulated PLC with two axes", title)
    (folder / f"{name}.toml").write_text(text, encoding="utf-8")


def test_ones_own_profile_is_found_read_again_when_changed_and_replaces_none(tmp_path: Path) -> None:
    own(tmp_path, "mine")
    own(tmp_path, "simulated-plc", "Not the real one")
    library = ProfileLibrary(tmp_path)
    assert library.names() == tuple(sorted((*known_profiles(), "mine")))
    assert library.load("mine").title == "Mine"
    own(tmp_path, "mine", "Mine, another edition")
    assert library.load("mine").title == "Mine, another edition"
    assert library.load("simulated-plc").title == "Simulated PLC with two axes"


@pytest.mark.parametrize("name", ["../secret", "/etc/secret", "mine.toml", "a\0b", "", "nonsense"])
def test_a_name_leads_nowhere_else(tmp_path: Path, name: str) -> None:
    folder = tmp_path / "profiles"
    folder.mkdir()
    own(tmp_path, "secret")
    own(folder, "mine")
    with pytest.raises(ProfileError, match=r"There is no drive profile .* simulated-plc, .*profiles"):
        ProfileLibrary(folder).load(name)


def test_a_tracker_cannot_be_given_a_file_elsewhere_or_two_drives_with_one_unit_id(tmp_path: Path) -> None:
    own(tmp_path, "secret")
    factory = DriveFactory(VirtualClock(START), tmp_path / "data")
    for profile, why in (
        (str(tmp_path / "secret.toml"), "no drive profile"),
        ("kinco-cia402", "Both axes have unit 4.*a different unit id"),
    ):
        drive = DriveConfig(DriveKind.MODBUS_TCP, profile, unit=4)
        with pytest.raises(ProfileError, match=why):
            factory.make(replace(CONFIG, drive=drive))
