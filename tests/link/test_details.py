"""Details over the link: only what has changed is sent, and the far end always has the whole."""

import asyncio
from dataclasses import replace
from pathlib import Path
from random import Random

import pytest

from app.link.codec import Detailed, Details, decode_telling, encode_telling
from app.link.details import MOST_AT_ONCE, Received, Sent, answer
from app.link.messages import MachineUnreachable, SiteDetail, TrackerDetail
from app.link.server import LinkServer
from app.tracker.memory.memory import SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig
from tests.link.test_link import ScriptedMachine, linked, snapshot
from tests.patience import eventually


def tracker(name: str, title: str = "Tracker") -> TrackerDetail:
    return TrackerDetail(TrackerState(TrackerConfig(name, title), TrackerMemory()), (), None)


def field_of(count: int) -> SiteDetail:
    names = [f"T{number}" for number in range(count)]
    return SiteDetail(SiteState(name="Samsun"), {name: tracker(name) for name in names})


def sent_over(sent: Sent, received: Received, detail: SiteDetail) -> tuple[SiteDetail, list[int]]:
    """Send an answer as bytes; return what the far end has then, and how many trackers each part held."""
    sizes = []
    for part in sent.parts(detail):
        told = decode_telling(encode_telling(part)[4:])
        assert isinstance(told, Details)
        sizes.append(len(told.trackers))
        received.take(told)
    answered = decode_telling(encode_telling(answer(1, detail))[4:])
    assert isinstance(answered, Detailed)
    return received.whole(answered), sizes


@pytest.mark.parametrize("count", [0, MOST_AT_ONCE, MOST_AT_ONCE + 1])
def test_a_field_is_sent_whole_in_small_parts_and_then_only_what_changed(count: int) -> None:
    sent, received, detail = Sent(), Received(), field_of(count)

    first, sizes = sent_over(sent, received, detail)
    again, repeated = sent_over(sent, received, replace(detail, trackers=dict(detail.trackers)))

    assert first == again == detail
    assert list(first.trackers) == list(detail.trackers)
    assert sum(sizes) == count
    assert all(size <= MOST_AT_ONCE for size in sizes)
    assert not repeated


def test_whatever_changes_comes_or_goes_the_far_end_has_the_whole() -> None:
    dice, sent, received = Random(13), Sent(), Received()
    detail = field_of(40)
    sent_over(sent, received, detail)
    for step in range(60):
        trackers = dict(detail.trackers)
        changed = dice.sample(sorted(trackers), k=min(len(trackers), dice.randrange(4)))
        for name in changed:
            trackers[name] = tracker(name, f"Title {step}")
        for name in dice.sample(sorted(trackers.keys() - set(changed)), k=dice.randrange(2)):
            del trackers[name]
        if dice.random() < 0.5:
            changed.append(f"N{step}")
            trackers[f"N{step}"] = tracker(f"N{step}")
        before, detail = received.whole(answer(1, detail)), replace(detail, trackers=trackers)
        kept = dict(before.trackers)

        whole, sizes = sent_over(sent, received, detail)

        assert whole == detail
        assert list(whole.trackers) == list(trackers)
        assert sum(sizes) == len(changed)
        assert before.trackers == kept


class Fresh(Received):
    """An end that was connected anew after its answer was on the way."""

    def take(self, part: Details) -> None:
        """Forget it, as the end of the link does when the link is down."""


class Detailing(ScriptedMachine):
    """Tells the details that the test put there, after everything else that waits has had a turn."""

    told = field_of(50)

    async def detail(self) -> SiteDetail:
        await asyncio.sleep(0)
        return self.told


async def test_over_the_socket_every_question_gets_the_whole_also_after_a_restart(tmp_path: Path) -> None:
    machine = Detailing()
    machine.outlet.publish(snapshot(1))
    async with linked(machine, tmp_path) as link:
        client = link.client
        both = await asyncio.gather(client.detail(), client.detail())
        assert both == [machine.told] * 2
        machine.told = replace(machine.told, trackers=machine.told.trackers | {"T7": tracker("T7", "Seven")})
        assert await client.detail() == machine.told
        await link.server.close()
        await eventually(lambda: client.latest() is None)
        link.server = LinkServer(machine, link.path)
        await link.server.start()
        await link.until_up()
        assert await client.detail() == machine.told
        client._details = Fresh()
        with pytest.raises(MachineUnreachable, match="in time"):
            await client.detail()
