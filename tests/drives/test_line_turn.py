"""How long a line's turn takes: reckoned from its baud rate, then as measured."""

import pytest

from app.drives.profile import load_profile
from app.modbus.line_turn import Part, serial_part_s
from app.tracker.settings.config import SerialConfig

TIMING = load_profile("simulated-plc").timing


@pytest.mark.parametrize(("baud_rate", "part_ms"), [(19_200, 80.5), (115_200, 27.4), (1_000_000, 18.2)])
def test_a_part_of_a_serial_line_is_what_its_characters_silences_and_replies_take(
    baud_rate: int, part_ms: float
) -> None:
    """8 + 85 characters of a poll of 40 registers, 16 of a write, at 11 bits; four silences, two replies."""
    part_s = serial_part_s(SerialConfig("/dev/none", baud_rate), TIMING)
    assert part_s * 1000.0 == pytest.approx(part_ms, abs=0.05)


def test_a_part_is_measured_once_the_device_has_answered() -> None:
    part = Part(0.08)
    assert part.takes_s == 0.08
    assert Part(0.0).takes_s == 0.01, "behind a gateway nothing is known before"
    part.note(0, 0.05, written=False)
    part.note(20, 0.01, written=True)
    part.note(21, 0.01, written=True)
    assert part.takes_s == pytest.approx(0.06)
    part.note(100, 0.03, written=False)
    assert part.takes_s == pytest.approx(0.09)
    for _ in range(60):
        part.note(0, 0.10, written=False)
    assert part.takes_s == pytest.approx(0.14, abs=0.001)
