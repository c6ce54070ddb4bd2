"""The bytes that writing a register puts on a serial line, to be held against a device's manual."""

from collections.abc import Mapping

from app.drives.profile import Profile
from app.drives.register import Access, runs
from app.modbus.rtu_frame import request_frame
from app.modbus.wire import Ask


def write_frame(profile: Profile, values: Mapping[str, float], unit: int) -> bytes:
    """Return the RTU frame that writes neighbouring registers, or raise `ValueError` if that takes more.

    Raises `ValueMisfit` for a value that does not fit into its register.
    """
    words: dict[int, int] = {}
    for name, value in values.items():
        register = profile.registers.get(name)
        if register is None:
            raise ValueError(f"Profile {profile.name} has no register {name!r}.")
        if register.access is Access.READ:
            raise ValueError(f"Register {name} of profile {profile.name} can only be read.")
        words |= register.placed(value)
    frames = runs(words, words)
    if len(frames) != 1:
        raise ValueError("These registers are no neighbours: each takes a frame of its own.")
    address, run = frames[0]
    return request_frame(Ask(unit, address, len(run), tuple(run)))
