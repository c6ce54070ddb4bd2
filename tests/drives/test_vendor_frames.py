"""Frames printed in the vendors' manuals, byte for byte, from our profiles and adapters.

Source of each frame: `tests/golden/vendor-frames.csv`, last column.
"""

import csv
from dataclasses import dataclass
from pathlib import Path

import pytest

from app.drives.dialects.cia402_axis import Cia402Axis
from app.drives.dialects.gearing import Gearing
from app.drives.dialects.pr_axis import PathBlock, PrAxis
from app.drives.profile import Profile, load_profile
from app.drives.register import Register, WordOrder, WordType
from app.drives.unit import Unit
from app.drives.write_frame import write_frame
from app.modbus.rtu_frame import is_sealed, is_whole, request_frame, sealed
from app.modbus.wire import Ask
from tests.drives.test_requests import NotingLink

GOLDEN = Path(__file__).parents[1] / "golden" / "vendor-frames.csv"
ROWS = list(csv.DictReader(GOLDEN.read_text(encoding="utf-8").splitlines()))
FRAMES = {row["what"]: bytes.fromhex(row["frame_hex"]) for row in ROWS}
KINCO, LEADSHINE, ORIENTAL = map(load_profile, ("kinco-cia402", "leadshine-rs", "oriental-az"))


@dataclass
class Wiretap(NotingLink):
    """A device that takes everything, and the frames that a serial line would carry."""

    unit: int = 1

    @property
    def read_frames(self) -> list[bytes]:
        return [request_frame(Ask(self.unit, address, count)) for address, count, *_ in self.reads]

    @property
    def frames(self) -> list[bytes]:
        return [
            request_frame(Ask(self.unit, address, len(words), tuple(words)))
            for address, words, *_ in self.writes
        ]


def kinco(steps_per_revolution: float) -> tuple[Cia402Axis, Wiretap]:
    tap = Wiretap()
    unit = Unit(KINCO, tap, "the tap")
    return Cia402Axis(unit, Gearing(steps_per_revolution, 36.0), 6.0), tap


def rpm(speed: float) -> float:
    """Degrees a second of an axis behind a gear of 36 whose motor turns so fast."""
    return speed * 6.0 / 36.0


def word(profile: Profile, register: str, name: str) -> dict[str, float]:
    return {register: profile.enums[register][name]}


WRITTEN = {
    "Leadshine save parameters 0x1801=0x2211": (LEADSHINE, word(LEADSHINE, "control", "save_parameters"), 1),
    "Leadshine save mapping 0x1801=0x2244": (LEADSHINE, word(LEADSHINE, "control", "save_mapping"), 1),
    "Oriental AZ position -1000 at 0x1802": (ORIENTAL, {"stored_position": -1000}, 1),
    "Kinco controlword 0x3100=0x000F": (KINCO, {"controlword": 0x0F}, 1),
    "Leadshine CS2RS PR0 block, absolute 10000 pulses, velocity 0": (
        LEADSHINE,
        PathBlock(1, 10000, 0, 10000, 10000, LEADSHINE.enums["path_trigger"]["start"]).values(),
        7,
    ),
}


@pytest.mark.parametrize("what", WRITTEN)
def test_a_profile_writes_the_printed_frame(what: str) -> None:
    profile, values, unit = WRITTEN[what]
    assert write_frame(profile, values, unit) == FRAMES[what]


async def test_kinco_reads_its_statusword_as_printed() -> None:
    axis, tap = kinco(10000.0)
    await Unit(KINCO, tap, "the tap").poll(*axis.polled)
    assert tap.read_frames == [FRAMES["Kinco read statusword 0x3200"]]


async def test_kinco_homing_gives_the_printed_controlwords() -> None:
    axis, tap = kinco(10000.0)
    await axis.home()
    assert tap.frames[-2:] == [
        FRAMES["Kinco controlword 0x3100=0x000F"],
        request_frame(Ask(1, 0x3100, 1, (0x1F,))),
    ]


@pytest.mark.parametrize(
    ("what", "steps_per_revolution", "speed_rpm"),
    [
        ("Kinco target velocity 0x6F00=0x00085555", 10000.0, 200.0),
        ("Kinco target velocity 100 rpm", 65536.0, 100.0),
    ],
)
async def test_kinco_turns_with_the_printed_speed(
    what: str, steps_per_revolution: float, speed_rpm: float
) -> None:
    axis, tap = kinco(steps_per_revolution)
    await axis.turn(rpm(speed_rpm))
    assert FRAMES[what] in tap.frames


async def test_leadshine_moves_with_the_printed_frame_but_its_speed() -> None:
    """The manual's text says 200 rpm, its frame 0: ours is the frame with the speed of the text."""
    tap = Wiretap(unit=7)
    acceleration_dps2 = rpm(1000.0) / 10.0
    axis = PrAxis(Unit(LEADSHINE, tap, "the tap"), Gearing(10000.0, 36.0), acceleration_dps2)
    await axis.move(10000, rpm(200.0), confirmed=False)
    printed = bytearray(FRAMES["Leadshine CS2RS PR0 block, absolute 10000 pulses, velocity 0"][:-2])
    printed[13:15] = (200).to_bytes(2, "big")
    assert tap.frames == [sealed(bytes(printed))]


def test_leadshine_printed_replies_are_taken_for_what_they_are() -> None:
    asked = Ask(7, 0x6200, 8, (0,) * 8)
    assert is_whole(FRAMES["Leadshine reply to it"], asked.wanted)
    assert is_whole(FRAMES["Leadshine exception 08"], Ask(1, 0x6200, 8).wanted)


def test_leadshine_peak_current_is_as_printed_but_the_checksum_which_is_a_misprint() -> None:
    printed = FRAMES["Leadshine peak current 0x0191=0x0020"]
    ours = write_frame(LEADSHINE, {"peak_current": 0x20}, 1)
    assert (ours[:-2], ours[-2:]) == (printed[:-2], bytes.fromhex("D803"))
    assert not is_sealed(printed)


def test_delta_printed_frames_are_ours() -> None:
    """A coil of the PLC and a servo of the same maker, which no profile has: packing and checksum alone."""
    assert sealed(bytes.fromhex("01050500FF00")) == FRAMES["Delta DVP force Y0 on"]
    distance = Register("distance", 0x0112, WordType.UINT32, WordOrder.LOW_FIRST)
    frame = request_frame(Ask(1, distance.address, distance.count, distance.words(3000)))
    assert frame == FRAMES["Delta ASDA write P1-09"]


def test_every_printed_frame_has_the_checksum_that_the_table_says() -> None:
    assert {row["what"]: is_sealed(FRAMES[row["what"]]) for row in ROWS} == {
        row["what"]: row["crc_correct"] == "yes" for row in ROWS
    }
