"""How long a test waits before it gives up what hangs: one bound for all, which judges nothing.

`HELIOPANEL_TEST_PATIENCE_S` sets it: the gate's computer may be as slow as it likes.
"""

import asyncio
import os
import time
from collections.abc import Callable

PATIENCE_S = float(os.environ.get("HELIOPANEL_TEST_PATIENCE_S", "60"))
PATIENCE_MS = int(1000 * PATIENCE_S)
TEST_S = 3.0 * PATIENCE_S
"""A test may lose its patience once and still say what it waited for."""
LOOK_EVERY_S = 0.02


def until(found: Callable[[], object], what: str, *, within_s: float = PATIENCE_S) -> None:
    """Return once something is so, or fail; only a soak has a bound of its own."""
    give_up = time.monotonic() + within_s
    while not found():
        if time.monotonic() > give_up:
            raise TimeoutError(f"Not so within {within_s} s: {what}.")
        time.sleep(LOOK_EVERY_S)


async def eventually(found: Callable[[], object], *, within_s: float = PATIENCE_S) -> None:
    """Return once something is so, or fail, while the loop goes on; only a soak has a bound of its own."""
    give_up = time.monotonic() + within_s
    while not found():
        if time.monotonic() > give_up:
            raise TimeoutError(f"It did not become so within {within_s} s.")
        await asyncio.sleep(LOOK_EVERY_S)


async def pause() -> None:
    """Let the others work before something is looked at again."""
    await asyncio.sleep(LOOK_EVERY_S)
