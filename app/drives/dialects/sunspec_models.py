"""Where a SunSpec device has its models: a chain of headers, each a number and a length.

Source: SunSpec Device Information Model Specification: "SunS" at a base address, the models, then 0xFFFF.
"""

from dataclasses import replace

from app.base.message import say
from app.drives.profile import Block, Profile
from app.drives.unit import Link, Unit
from app.modbus.errors import DriveRefused

END_MODEL, MOST_MODELS = 0xFFFF, 40
CONTROLLER_LENGTH, TRACKER_LENGTH = 26, 22
MODEL_HEADER = 2
MARK = ("sunspec_id", "sunspec_id_end")


async def located(profile: Profile, link: Link, where: str) -> Profile:
    """Return the profile with its model and its tracker where this device has them, or raise `DriveError`.

    Registers from `model` on are moved; `first_model` is where the chain begins.
    """
    await _identify(profile, link, where)
    wanted = profile.registers["model"].expect
    address = profile.registers["first_model"].address
    for _ in range(MOST_MODELS):
        model, length = await link.read(address, MODEL_HEADER, what=f"model header of profile {profile.name}")
        if model == wanted:
            found = _shifted(profile, address)
            _check_count(found, length, where)
            return found
        if model == END_MODEL:
            break
        address += MODEL_HEADER + length
    raise DriveRefused(
        say(
            "The device at {where} has no SunSpec model {wanted}. Check unit and profile.",
            where=where,
            wanted=wanted,
        )
    )


async def _identify(profile: Profile, link: Link, where: str) -> None:
    found = await Unit(profile, link, where).poll(*MARK)
    if any(value != profile.registers[name].expect for name, value in found.items()):
        raise DriveRefused(
            say(
                "The device at {where} is not a SunSpec device: its map does not begin with SunS. "
                "Check address, unit and profile.",
                where=where,
            )
        )


def _check_count(profile: Profile, length: int, where: str) -> None:
    trackers = (length - CONTROLLER_LENGTH) // TRACKER_LENGTH
    if profile.tracker > trackers:
        raise DriveRefused(
            say(
                "The tracker controller at {where} has {trackers} trackers, but profile {profile} needs "
                "number {number}. Correct tracker in the profile.",
                where=where,
                trackers=trackers,
                profile=profile.name,
                number=profile.tracker,
            )
        )


def _shifted(profile: Profile, model_address: int) -> Profile:
    """Return the profile with everything from model 601 on where this device has it.

    The points of the repeated block become those of the profile's tracker, in a frame of their own where the
    controller's own points are not its neighbours any more.
    """
    first = profile.registers["model"].address
    repeated = first + MODEL_HEADER + CONTROLLER_LENGTH
    by, on = model_address - first, (profile.tracker - 1) * TRACKER_LENGTH

    def moved(address: int) -> int:
        return address + (by if address >= first else 0) + (on if address >= repeated else 0)

    blocks = [
        replace(part, address=moved(part.address))
        for block in profile.blocks.values()
        for part in (_split(block, repeated) if on else (block,))
    ]
    return replace(
        profile,
        registers={name: replace(one, address=moved(one.address)) for name, one in profile.registers.items()},
        blocks={block.name: block for block in blocks},
    )


def _split(block: Block, at: int) -> tuple[Block, ...]:
    """Return what of a block lies before an address and what from there on."""
    before = min(max(at - block.address, 0), block.count)
    parts = (
        Block(block.name, block.address, before),
        Block(f"{block.name}, repeated", block.address + before, block.count - before),
    )
    return tuple(part for part in parts if part.count)
