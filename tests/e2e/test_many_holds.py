"""A thousand buttons held behind a network that is cut: the tail of what is promised, not its median."""

import asyncio
import random

from tests.e2e.holds import ONE_BY_ONE, Tally, rig
from tests.e2e.socket_page import LetGo

TRACKERS = 8
CUTS, OTHERS = 1000, 25
LONGEST_MS = 300.0
P999_MS = 280.0


def test_a_thousand_cut_networks_and_every_other_way_of_letting_go() -> None:
    """One late end in two hundred, as there was, is seen here with a probability of 99.3 %."""
    ways = [way for way in ONE_BY_ONE for _ in range(CUTS if way is LetGo.CUT else OTHERS)]
    random.Random(13).shuffle(ways)
    with rig(TRACKERS) as held:
        tally = asyncio.run(held.let_go(ways))
    print(tally.held, tally.refused, tally.stopped_by_itself, tally.not_held, tally.why[:3])
    assert tally.moved_again == 0
    assert tally.stopped_by_itself + tally.refused + tally.not_held <= len(ways) // 100
    _in_time(tally)


def _in_time(tally: Tally) -> None:
    for way, took_ms in tally.took_ms.items():
        longest = sorted(took_ms)
        print(f"{way}: {len(longest)}, longest {[round(one) for one in longest[-5:]]} ms")
        assert longest[-1] <= LONGEST_MS, way
    cuts = sorted(tally.took_ms[LetGo.CUT])
    assert cuts[-2] <= P999_MS
