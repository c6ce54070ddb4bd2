"""Access: whether the time of a refused log-in tells if a name is known, with the real hashes"""

import asyncio
import tempfile
from contextlib import suppress
from datetime import timedelta
from pathlib import Path
from statistics import median
from time import perf_counter

from app.access.keeper import Keeper, WrongPassword
from app.access.opening import open_keeper
from app.access.principal import this_computer
from app.access.roles import Role
from app.clock import VirtualClock
from app.settings import Settings
from bench.table import Row
from tests.fake_data import NOON

COMMAND = "python -m bench access"
TRIES = 30
RIGHT, WRONG = "violet-anvil-harbour-9", "quiet-lantern-meadow-4"
BETWEEN = timedelta(minutes=1)


def measure() -> list[Row]:
    """Measure wrong passwords of a known name and of an unknown one, in turn."""
    with tempfile.TemporaryDirectory() as folder:
        known, unknown = asyncio.run(_measured(Path(folder)))
    spread = sorted(known)[round(0.75 * TRIES)] - sorted(known)[round(0.25 * TRIES)]
    return [
        Row(
            f"a refused log-in, median of {TRIES}: known name, unknown name (middle half of the known)",
            f"{median(known) * 1000:.1f} ms, {median(unknown) * 1000:.1f} ms ({spread * 1000:.1f} ms)",
            "the same",
            f"{median(unknown) / median(known):.3f}",
            COMMAND,
        )
    ]


async def _measured(folder: Path) -> tuple[list[float], list[float]]:
    clock = VirtualClock(NOON)
    keeper = open_keeper(Settings(data_dir=folder), clock)
    here, now = this_computer("127.0.0.1"), clock.now()
    await keeper.do(lambda: keeper.accounts.add(here, "ada", {Role.ADMINISTRATOR}, RIGHT, now))
    times: dict[str, list[float]] = {"ada": [], "eve": []}
    for number in range(TRIES + 1):
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
