"""Profiles: what the loader takes, and the sentences with which it refuses."""

from pathlib import Path

import pytest

from app.drives.connections.profile_needs import check_needs
from app.drives.dialects.plc_map import PlcMap
from app.drives.profile import PROFILES, ProfileError, known_profiles, load_profile, parse_profile
from app.drives.register import Register, ValueMisfit, WordOrder, WordType
from app.simulation.profile_page import DOCS, renewed

TEXT = (PROFILES / "simulated-plc.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", known_profiles())
def test_every_profile_that_ships_can_be_loaded(name: str) -> None:
    profile = load_profile(name)
    assert profile.name == name
    assert all(register.source for register in profile.registers.values())
    check_needs(profile)


@pytest.mark.parametrize("name", known_profiles())
def test_the_page_of_every_profile_is_up_to_date(name: str) -> None:
    written = (DOCS / f"{name}.md").read_text(encoding="utf-8")
    assert written == renewed(written, load_profile(name)), "run python -m app.simulation.profile_page"


def test_a_profile_can_be_a_file_of_ones_own(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    own.write_text(TEXT.replace('name = "simulated-plc"', 'name = "own"'), encoding="utf-8")
    assert load_profile(str(own)).name == "own"


def test_an_unknown_profile_is_answered_with_those_there_are() -> None:
    with pytest.raises(ProfileError, match=r"Choose one of .*simulated-plc"):
        load_profile("nonsense")


WRONG = {
    "unknown type": ('"int32", scale = 0.001, unit = "deg",', '"i", unit = "deg",', r"line \d+, .*one of"),
    "overlap": ("elevation_position = { address = 10", "elevation_position = { address = 9", "is taken by"),
    "missing address": ("identity = { address = 0, ", "identity = { ", r"identity.address: is missing"),
    "unknown key": ("heartbeat = { address = 2,", "heartbeat = { adress = 2,", r"adress: is not known"),
    "address too high": ("address = 33", "address = 70000", "between 0 and 65535"),
    "scale zero": ("scale = 0.001, unit = \"deg\"", "scale = 0, unit = \"deg\"", "above zero"),
    "sign zero": ("text = \"Bits, see below\" }\nswitches", "sign = 0 }\nswitches", "must be 1 or -1"),
    "text for a number": ("timeout_ms = 300", 'timeout_ms = "300"', "a whole number"),
    "number for text": ('title = "Simulated PLC with two axes"', "title = 5", "text in quotes"),
    "no such adapter": ('adapter = "plc"', 'adapter = "plx"', "must be one of plc, cia402"),
    "bit given twice": ("homing = 4", "homing = 3", "given twice"),
    "bit above 15": ("request_failed = 6", "request_failed = 16", "between 0 and 15"),
    "watchdog without register": ('register = "keep_alive"', 'register = "nothing"', "names no register"),
    "block too large": ("count = 40", "count = 126", "between 1 and 125"),
    "not TOML": ("[timing]", "[timing", "not TOML.*line"),
    "name with a blank": ('"simulated-plc"', '"Simulated PLC"', r"line \d+, name: .*lowercase"),
    "bits of nothing": ("[bits.switches]", "[bits.switch]", r"line \d+, bits.switch: .*no register switch"),
    "words of nothing": ("[enums.motion]", "[enums.motions]", r"line \d+, enums.motions: .*no register"),
    "block that cuts": ("count = 40", "count = 11", r"line \d+, blocks.status: cuts register elev"),
    "empty block": ("address = 0, count = 40", "address = 900, count = 40", "blocks.status: holds no"),
    "block past the end": ("address = 0, count = 40", "address = 65530, count = 40", "not at 65569"),
    "wide at the end": ("position = { address = 8,", "position = { address = 0xFFFF,", "second word"),
    "bounds turned": ("minimum = -1080,", "minimum = 2080,", r"line \d+, .*minimum: must not lie above"),
    "scale not a number": ("scale = 0.001, unit = \"deg\"", "scale = nan, unit = \"deg\"", "not nan"),
    "late before too late": ("poll_ms = 100", "longest_reply_ms = 20", r"line \d+, .*shorter than timeout"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_a_wrong_profile_is_refused_with_file_line_and_rule(name: str) -> None:
    right, wrong, sentence = WRONG[name]
    assert right in TEXT
    with pytest.raises(ProfileError, match=sentence) as caught:
        parse_profile(TEXT.replace(right, wrong, 1), "own.toml")
    assert str(caught.value).startswith("own.toml")


LACKING = {
    "a register": ("keep_alive = {", "kept_alive = {", "needs a register named keep_alive"),
    "a block": ("status = { address = 0, count", "stat = { address = 0, count", "block named status"),
    "status bits": ("[bits.status]", "[bits.echo]", "needs the bits"),
    "a word": ("velocity = 1\n", "speed = 1\n", "needs the word velocity"),
    "room in the block": ("count = 40", "count = 20", "outside the status block"),
    "switches in the block": ("switches = { address = 6,", "switches = { address = 99,", "switches lies out"),
}  # fmt: skip


@pytest.mark.parametrize("name", LACKING)
def test_a_profile_that_lacks_what_a_plc_needs_is_refused(name: str) -> None:
    right, wrong, sentence = LACKING[name]
    text = TEXT.replace(right, wrong, 1).replace('register = "keep_alive"', 'register = "echo"')
    with pytest.raises(ProfileError, match=sentence):
        PlcMap(parse_profile(text, "own.toml"))


def test_a_file_in_another_encoding_is_told_with_its_line(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    own.write_bytes(TEXT.replace("Simulated PLC with", "Simulierte Antriebe für").encode("latin-1"))
    with pytest.raises(ProfileError, match=r"own\.toml, line \d+: this is not UTF-8"):
        load_profile(str(own))


def test_a_table_is_found_in_spite_of_its_comment() -> None:
    text = TEXT.replace("[bits.status]", "[bits.status]   # what moves").replace("homing = 4", "homing = 40")
    line = next(number for number, one in enumerate(text.splitlines(), 1) if one.startswith("homing = 40"))
    with pytest.raises(ProfileError, match=rf"line {line}, bits\.status\.homing: must lie between"):
        parse_profile(text, "own.toml")


def test_a_wide_register_has_32_bits() -> None:
    text = (PROFILES / "kinco-cia402.toml").read_text(encoding="utf-8")
    text = text.replace("origin = 2", "origin = 2\nbrake = 31")
    assert parse_profile(text, "own.toml").bits["inputs"]["brake"] == 31


def test_a_line_that_is_not_verified_makes_the_profile_unverified() -> None:
    text = TEXT.replace("heartbeat = { address = 2,", "heartbeat = { address = 2, verified = false,")
    assert load_profile("simulated-plc").verified
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
