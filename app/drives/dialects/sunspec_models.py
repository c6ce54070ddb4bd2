"""Where a SunSpec device has its models: a chain of headers, each a number and a length.

Source: SunSpec Device Information Model Specification: "SunS" at a base address, the models, then 0xFFFF.
"""

from dataclasses import replace
from typing import Protocol

from app.base.message import N_, Message, data, join, say, told_by
from app.drives.profile import Block, Profile
from app.modbus.errors import DriveError, DriveRefused, DriveSilent

BASES = (40000, 50000, 0)
"""Where a map may begin, as the specification lists it."""
MARK = [0x5375, 0x6E53]
END_MODEL, MOST_MODELS, ADDRESSES = 0xFFFF, 40, 0x10000
CONTROLLER_LENGTH, TRACKER_LENGTH = 26, 22
MODEL_HEADER = 2
NO_ANSWER, REFUSED, FAILED = N_("no answer"), N_("refused"), N_("failed")


class Reading(Protocol):
    """A device whose registers can be read."""

    async def read(self, address: int, count: int, *, what: str) -> list[int]:
        """Return holding registers, or raise `DriveError`."""


class MapSearch:
    """Finds where the map of a device begins, at one base after the other.

    A base at which nothing answers is passed over, also where the caller gave up waiting: the next call goes
    on with the next one. A base that was right before is tried first.
    """

    def __init__(self, first: int = BASES[0]) -> None:
        self._bases = [first, *(base for base in BASES if base != first)]
        self._answers: dict[int, Message] = {}
        self._silent: DriveSilent | None = None

    async def base(self, link: Reading, where: str) -> int:
        """Return the address of the mark, or raise `DriveError` that says what each base answered."""
        for base in [base for base in self._bases if base not in self._answers]:
            self._answers[base] = NO_ANSWER
            try:
                words = await link.read(base, len(MARK), what=N_("the beginning of the SunSpec map"))
            except DriveSilent as error:
                self._silent = error
            except DriveRefused:
                self._answers[base] = REFUSED
            except DriveError:
                self._answers[base] = FAILED
            else:
                if list(words) == MARK:
                    self._bases.insert(0, self._bases.pop(self._bases.index(base)))
                    self._answers.clear()
                    return base
                self._answers[base] = data(" ".join(f"0x{word:04X}" for word in words))
        raise self._not_found(where)

    def _not_found(self, where: str) -> DriveError:
        """Return what each base answered, and begin anew."""
        answers, silent = self._answers, self._silent
        self._answers, self._silent = {}, None
        listed = join("; ", (say("{base}: {answer}", base=base, answer=answers[base]) for base in answers))
        tried = say(
            "The device at {where} is not a SunSpec device: no register map begins with SunS ({answers}). "
            "Check address, unit, and profile.",
            where=where,
            answers=listed,
        )
        if set(answers.values()) != {NO_ANSWER}:
            return DriveRefused(tried)
        unanswered = say("No SunSpec map answers ({answers}).", answers=listed)
        return DriveSilent(unanswered if silent is None else join(" ", (told_by(silent), unanswered)))


async def model_at(link: Reading, base: int, wanted: int, where: str) -> tuple[int, int]:
    """Return address and length of a model in the map that begins at a base, or raise `DriveError`."""
    address = base + len(MARK)
    for _ in range(MOST_MODELS):
        if address + MODEL_HEADER > ADDRESSES:
            break
        what = N_("the header of a SunSpec model")
        model, length = await link.read(address, MODEL_HEADER, what=what)
        if model == wanted and 0 < length <= ADDRESSES - MODEL_HEADER - address:
            return address, length
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


async def located(profile: Profile, link: Reading, where: str, search: MapSearch | None = None) -> Profile:
    """Return the profile with its model and its tracker where this device has them, or raise `DriveError`.

    Registers from `model` on are moved to where the model is, those before it with the base of the map.
    """
    first, wanted = profile.registers["sunspec_id"].address, profile.registers["model"].expect or 0
    base = await (search or MapSearch(first)).base(link, where)
    address, length = await model_at(link, base, wanted, where)
    found = _shifted(profile, address, base - first)
    _check_count(found, length, where)
    return found


def _check_count(profile: Profile, length: int, where: str) -> None:
    trackers = max(0, (length - CONTROLLER_LENGTH) // TRACKER_LENGTH)
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


def _shifted(profile: Profile, model_address: int, base_by: int) -> Profile:
    """Return the profile with everything from model 601 on where this device has it, the rest with the base.

    The points of the repeated block become those of the profile's tracker, in a frame of their own where the
    controller's own points are not its neighbours any more.
    """
    first = profile.registers["model"].address
    repeated = first + MODEL_HEADER + CONTROLLER_LENGTH
    by, on = model_address - first, (profile.tracker - 1) * TRACKER_LENGTH

    def moved(address: int) -> int:
        return address + (by if address >= first else base_by) + (on if address >= repeated else 0)

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
