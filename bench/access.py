"""Access: whether the time of a refused log-in tells if a name is known, with the real hashes"""

import asyncio
import tempfile
from contextlib import suppress
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path
from statistics import median
from time import perf_counter

from app.access.authenticator import Keeper, WrongPassword
from app.access.opening import open_keeper
from app.access.principal import this_computer
from app.access.roles import Role
from app.base.clock import VirtualClock
from app.base.settings import Settings
from bench.table import Row, at_most
from tests.fake_data import NOON

COMMAND = "python -m bench access"
MOST_APART = 0.05
RIGHT, WRONG = "violet-anvil-harbour-9", "quiet-lantern-meadow-4"
BETWEEN = timedelta(minutes=1)


@dataclass(frozen=True, slots=True)
class Size:
    """How often each name is tried."""

    tries: int = 30


SMALL = Size(tries=2)


def measure(size: Size = Size()) -> list[Row]:
    """Measure wrong passwords of a known name and of an unknown one, in turn."""
    with tempfile.TemporaryDirectory() as folder:
        known, unknown = asyncio.run(_measured(Path(folder), size.tries))
    apart = abs(median(unknown) / median(known) - 1.0)
    name = f"a refused sign-in, median of {size.tries}: how far a known and an unknown name are apart"
    told = f"{median(known) * 1000:.1f} ms and {median(unknown) * 1000:.1f} ms: {apart:.1%}"
    return [at_most(name, apart, MOST_APART, "of one", COMMAND, ours=told)]


async def _measured(folder: Path, tries: int) -> tuple[list[float], list[float]]:
    clock = VirtualClock(NOON)
    keeper = open_keeper(Settings(data_dir=folder), clock)
    here, now = this_computer("127.0.0.1"), clock.now()
    await keeper.do(lambda: keeper.accounts.add(here, "ada", {Role.ADMINISTRATOR}, RIGHT, now))
    times: dict[str, list[float]] = {"ada": [], "eve": []}
    for number in range(tries + 1):
        for name, felt in times.items():
            took = await _refused(keeper, name, f"10.0.{number}.{len(name)}")
            felt += [took] if number else []
            clock.advance(BETWEEN)
    keeper.close()
    return times["ada"], times["eve"]


async def _refused(keeper: Keeper, name: str, address: str) -> float:
    begun = perf_counter()
    with suppress(WrongPassword):
        await keeper.log_in(name, WRONG, address, "bench")
    return perf_counter() - begun
