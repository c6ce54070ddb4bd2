"""A thousand buttons held behind a network that is cut: the tail of what is promised, not its median."""

import asyncio
import os
import random

from tests.e2e.holds import ONE_BY_ONE, Tally, busy, rig
from tests.e2e.socket_page import LetGo
from tests.soak import SOAK

TRACKERS = 8
CUTS, OTHERS = 1000, 25
BUSY = 10 if SOAK else 4
LONGEST_MS = 300.0
P999_MS = 280.0 if SOAK else LONGEST_MS
"""What depends on the computer is measured by `make soak`; what is promised holds in every run."""


def test_a_thousand_cut_networks_and_every_other_way_of_letting_go() -> None:
    """One late end in two hundred, as there was, is seen here with a probability of 99.3 %.

    Other programs keep the processors busy: where the panel has to wait as they do, one press in 150 ends
    while it is held, and as many are refused for a slow link.
    """
    ways = [way for way in ONE_BY_ONE for _ in range(CUTS if way is LetGo.CUT else OTHERS)]
    random.Random(13).shuffle(ways)
    with rig(TRACKERS) as held, busy(BUSY):
        tally = asyncio.run(held.let_go(ways))
    print(*tally.why, sep="\n")
    assert tally.moved_again == 0
    assert tally.not_held <= len(ways) // 100
    in_real_time = os.geteuid() == 0
    assert tally.stopped_by_itself + tally.refused <= (0 if in_real_time else len(ways) // 20)
    _in_time(tally)


def _in_time(tally: Tally) -> None:
    for way, took_ms in tally.took_ms.items():
        longest = sorted(took_ms)
        print(f"{way}: {len(longest)}, longest {[round(one) for one in longest[-5:]]} ms")
        assert longest[-1] <= LONGEST_MS, way
    cuts = sorted(tally.took_ms[LetGo.CUT])
    assert cuts[-2] <= P999_MS
