"""What an adapter needs of a profile, sequences, and degrees as a drive's units."""

import pytest

from app.drives.connections.profile_needs import check_needs
from app.drives.dialects.gearing import Gearing, gearing_of
from app.drives.profile import (
    PROFILES,
    ProfileError,
    SequenceStep,
    known_profiles,
    load_profile,
    parse_profile,
)
from app.tracker.settings.config import AxisDrive


def text_of(name: str) -> str:
    return (PROFILES / f"{name}.toml").read_text(encoding="utf-8")


LACKING = {
    "a register": (
        "kinco-cia402",
        "target_position = {",
        "goal = {",
        "needs a register named target_position",
    ),
    "a bit": ("kinco-cia402", "homed = 15", "found = 15", r"needs homed in bits\.statusword"),
    "a word": ("kinco-cia402", "set_home = 35", "zero = 35", r"needs set_home in enums\.homing_method"),
    "a known unit": (
        "kinco-cia402",
        'unit = "steps/s",',
        'unit = "furlongs",',
        "needs steps/s or rpm as the unit",
    ),
    "a known ramp": ("leadshine-rs", '"ms/1000rpm"', '"s"', "needs steps/s2 or ms/1000rpm as the unit"),
    "a sequence": ("oriental-az", "set_home = [", "zero = [", "needs a sequence named set_home"),
    "a model's point": ("sunspec-601", "scale = {", "power = {", "needs a register named scale"),
    "a counter that would overflow": (
        "simulated-plc",
        'keep_alive = { address = 20, type = "uint16"',
        'keep_alive = { address = 20, type = "int16"',
        "keep_alive counts to 65535",
    ),
}


@pytest.mark.parametrize("what", LACKING)
def test_a_profile_that_lacks_what_its_adapter_needs_is_refused(what: str) -> None:
    name, right, wrong, sentence = LACKING[what]
    text = text_of(name)
    assert right in text
    profile = parse_profile(text.replace(right, wrong, 1), "own.toml")
    with pytest.raises(ProfileError, match=rf"^own\.toml, line \d+, .*{sentence}"):
        check_needs(profile)


WRONG = {
    "a step without a register": ('"control = reset_alarm"', '"contrl = 1"', r"line \d+.*names no register"),
    "a step without a number": ('"control = reset_alarm"', '"control = sing"', "words in enums.control"),
    "a sequence that is a text": ('["enable = 1"]', '"enable = 1"', "a list of texts"),
    "a step that is only read": ('"enable = 1"', '"status = 1"', r"line \d+, .*can only be read"),
    "a step that does not fit": ('"enable = 1"', '"enable = 70000"', r"line \d+, .*does not fit into enable"),
    "a step without =": ('"enable = 1"', '"enable 1"', "must be written as"),
    "no steps": ("steps_per_revolution = 10000 ", "steps_per_revolution = 0 ", "above zero"),
}


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_sequence_or_axis_is_refused_with_its_line(what: str) -> None:
    right, wrong, sentence = WRONG[what]
    text = text_of("leadshine-rs")
    assert right in text
    with pytest.raises(ProfileError, match=sentence):
        parse_profile(text.replace(right, wrong, 1), "own.toml")


def test_a_word_whose_number_does_not_fit_is_refused_with_its_line() -> None:
    text = text_of("kinco-cia402").replace("home = 33 ", "home = 40000 ", 1)
    with pytest.raises(ProfileError, match=r"line \d+, enums.homing_method.home: 40000 does not fit into"):
        parse_profile(text, "own.toml")


def test_a_step_takes_a_word_or_a_number() -> None:
    sequences = load_profile("leadshine-rs").sequences
    assert sequences["reset_fault"] == (SequenceStep("control", 0x1111),)
    assert sequences["enable"] == (SequenceStep("enable", 1),)


@pytest.mark.parametrize("name", known_profiles())
def test_every_shipped_profile_says_where_each_register_is_from(name: str) -> None:
    profile = load_profile(name)
    assert all(len(register.source) > 10 for register in profile.registers.values())
    assert profile.verified == (not profile.unverified)


def test_degrees_become_steps_by_revolution_gear_and_direction() -> None:
    profile = load_profile("leadshine-rs")
    gearing = gearing_of(profile, AxisDrive(gear_ratio=36.0))
    assert gearing == Gearing(10000.0, 36.0, 1)
    assert (gearing.steps(90.0), gearing.degrees(-1000.0)) == (90000, -1.0)
    turned = gearing_of(profile, AxisDrive(steps_per_revolution=3600.0, gear_ratio=10.0, inverted=True))
    assert (turned.steps(1.5), turned.degrees(100.0)) == (-150, -1.0)


def test_speeds_and_ramps_come_in_the_drives_units() -> None:
    gearing = Gearing(10000.0, 36.0)
    assert gearing.speed(3.0, "rpm") == pytest.approx(18.0)
    assert gearing.speed(3.0, "steps/s") == pytest.approx(3000.0)
    assert gearing.velocity(-3.0, "rpm") == pytest.approx(-18.0)
    assert Gearing(10000.0, 36.0, -1).velocity_dps(18.0, "rpm") == pytest.approx(-3.0)
    assert gearing.ramp(6.0, "steps/s2") == pytest.approx(6000.0)
    assert gearing.ramp(6.0, "ms/1000rpm") == pytest.approx(1000.0 / 36.0 * 1000.0)


def test_the_slowest_speed_of_a_drive_is_not_zero() -> None:
    assert Gearing(200.0).speed(0.01, "rpm") == 1.0
    assert Gearing(200.0).speed(0.0, "rpm") == 0.0
