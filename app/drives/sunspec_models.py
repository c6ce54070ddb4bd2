"""Where a SunSpec device has its models: a chain of headers, each a number and a length.

Source: SunSpec Device Information Model Specification: "SunS" at a base address, the models, then 0xFFFF.
"""

from dataclasses import replace

from app.drives.drive import DriveRefused
from app.drives.profile import Profile
from app.drives.unit import Link, Unit

END_MODEL, MOST_MODELS = 0xFFFF, 40
MODEL_HEADER = 2
MARK = ("sunspec_id", "sunspec_id_end")


async def located(profile: Profile, link: Link, where: str) -> Profile:
    """Return the profile with its model where this device has it, or raise `DriveError`.

    Registers from `model` on are moved; `first_model` is where the chain begins.
    """
    await _identify(profile, link, where)
    wanted = profile.registers["model"].expect
    address = profile.registers["first_model"].address
    for _ in range(MOST_MODELS):
        model, length = await link.read(address, MODEL_HEADER, what=f"model header of profile {profile.name}")
        if model == wanted:
            return _shifted(profile, address)
        if model == END_MODEL:
            break
        address += MODEL_HEADER + length
    raise DriveRefused(f"The device at {where} has no SunSpec model {wanted}. Check unit and profile.")


async def _identify(profile: Profile, link: Link, where: str) -> None:
    found = await Unit(profile, link, where).poll(*MARK)
    if any(value != profile.registers[name].expect for name, value in found.items()):
        raise DriveRefused(
            f"The device at {where} is no SunSpec device: its map does not begin with SunS. "
            "Check address, unit and profile."
        )


def _shifted(profile: Profile, model_address: int) -> Profile:
    """Return the profile with everything from model 601 on where this device has it."""
    first = profile.registers["model"].address
    by = model_address - first
    return replace(
        profile,
        registers={
            name: replace(one, address=one.address + by) if one.address >= first else one
            for name, one in profile.registers.items()
        },
        blocks={
            name: replace(one, address=one.address + by) if one.address >= first else one
            for name, one in profile.blocks.items()
        },
    )
