"""Hold-to-run: from the last sign of a held button to velocity command 0 at a Modbus drive, the whole way"""

import asyncio
import random
import sys
from dataclasses import dataclass

from bench.table import Row, alone, at_most, must_hold, spread, worst
from tests.e2e.socket_page import LetGo
from tests.soak.rigs.holds import ONE_BY_ONE, Rig, Tally, busy, rig

COMMAND = "python -m bench jog"
LIMIT_MS, WATCHDOG_LIMIT_MS = 280.0, 520.0
"""How soon the axis must be told to rest; the drive's own watchdog waits 500 ms, and is looked at every 4."""
LONGEST_MS = 300.0
MOST_BY_ITSELF = 1e-4


@dataclass(frozen=True, slots=True)
class Size:
    """How many holds: of each way, of the network's cut; freezes, hands, and busy programs beside."""

    of_each: int = 1250
    of_cut: int = 10_000
    freezes: int = 32
    trackers: int = 16
    busy: int = 10


SMALL = Size(of_each=1, of_cut=2, freezes=1, trackers=2, busy=1)


def measure(size: Size = Size()) -> list[Row]:
    """Return how long a jog outlives its button, for every way of letting go."""
    with rig(size.trackers) as held, busy(size.busy):
        return asyncio.run(_rows(held, size))


async def _rows(held: Rig, size: Size) -> list[Row]:
    ways = [way for way in ONE_BY_ONE for _ in range(size.of_cut if way is LetGo.CUT else size.of_each)]
    random.shuffle(ways)
    one_by_one = await held.let_go(ways)
    frozen = [await held.freeze(way, size.freezes) for way in (LetGo.PANEL_FROZEN, LetGo.CONTROLLER_FROZEN)]
    rows = [_row(way, tally, size) for tally in (one_by_one, *frozen) for way in tally.took_ms]
    return [*rows, *_honest(one_by_one, *frozen)]


def _row(way: LetGo, tally: Tally, size: Size) -> Row:
    took_ms = tally.took_ms[way]
    name, value = worst(took_ms)
    beside = f"{size.trackers} trackers at once, {size.busy} busy programs beside"
    what = f"{way}: {len(took_ms):,} holds at {beside}, {name}"
    limit_ms = WATCHDOG_LIMIT_MS if way is LetGo.CONTROLLER_FROZEN else LIMIT_MS
    return at_most(what, value, limit_ms, "ms", COMMAND, ours=spread(took_ms))


def _honest(*tallies: Tally) -> list[Row]:
    """Return what else became of presses: none is tried again in silence."""
    held, by_itself, refused, not_held, again = (
        sum(getattr(tally, name) for tally in tallies)
        for name in ("held", "stopped_by_itself", "refused", "not_held", "moved_again")
    )
    for tally in tallies:
        print(*tally.why, sep="\n", end="", file=sys.stderr)
    after = [took_ms for tally in tallies for took_ms in tally.took_ms.get(LetGo.CUT, ())]
    return [
        at_most("the longest of all after the network was cut", max(after), LONGEST_MS, "ms", COMMAND),
        at_most(
            "holds whose axis was stopped although heartbeats continued", by_itself / max(1, held),
            MOST_BY_ITSELF, "of one", COMMAND, ours=f"{by_itself} of {held:,}",
        ),
        must_hold("axes that moved again after release", f"{again}", "0", COMMAND, holds=not again),
        alone(
            "presses refused; presses whose heartbeats the bench itself sent too late (not counted above)",
            f"{refused}; {not_held}", COMMAND,
        ),
    ]  # fmt: skip
