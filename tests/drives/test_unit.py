"""What a device refuses once is not gone for ever, and not asked for again and again."""

from app.drives.profile import load_profile
from app.drives.unit import Unit
from tests.drives.test_requests import NotingLink

PROFILE = load_profile("kinco-cia402")


INPUTS = PROFILE.registers["inputs"].address


def unit() -> tuple[Unit, NotingLink]:
    """A device that refuses one block for now."""
    link = NotingLink(refuses={INPUTS})
    return Unit(PROFILE, link, "here"), link


def times_asked(link: NotingLink) -> int:
    return [address for address, *_ in link.reads].count(INPUTS)


async def polled(unit: Unit) -> set[str]:
    return set(await unit.poll("position", "inputs"))


async def test_what_a_device_lacks_is_asked_for_once_a_connection() -> None:
    moody, link = unit()
    for _ in range(5):
        assert await polled(moody) == {"position"}
    assert (times_asked(link), moody.has("inputs")) == (1, False)
    link.ticket += 1
    for _ in range(5):
        assert await polled(moody) == {"position"}
    assert (times_asked(link), moody.has("inputs")) == (2, False)


async def test_what_was_refused_in_a_moment_is_read_over_the_next_connection() -> None:
    moody, link = unit()
    assert await polled(moody) == {"position"}
    link.refuses = set()
    assert await polled(moody) == {"position"}
    link.ticket += 1
    assert await polled(moody) == {"position", "inputs"}
    assert moody.has("inputs")
