"""What cannot be written in one frame is refused by name."""

import pytest

from app.drives.profile import load_profile
from app.drives.register import Access
from app.drives.write_frame import write_frame

PROFILE = load_profile("oriental-az")


def test_an_unknown_and_a_read_only_register_are_named() -> None:
    with pytest.raises(ValueError, match=r"^Profile oriental-az has no register 'nonsense'\.$"):
        write_frame(PROFILE, {"nonsense": 1.0}, 1)
    read_only = next(name for name, one in PROFILE.registers.items() if one.access is Access.READ)
    with pytest.raises(
        ValueError, match=rf"^Register {read_only} of profile oriental-az can only be read\.$"
    ):
        write_frame(PROFILE, {read_only: 1.0}, 1)


def test_registers_that_are_no_neighbors_are_refused() -> None:
    written = [
        (one.address, name) for name, one in PROFILE.registers.items() if one.access is not Access.READ
    ]
    first, last = min(written)[1], max(written)[1]
    with pytest.raises(ValueError) as refused:
        write_frame(PROFILE, {first: 0.0, last: 0.0}, 1)
    assert str(refused.value) == "These registers are no neighbours: each takes a frame of its own."
