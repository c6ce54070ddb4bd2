"""The controller's event loop: host names are looked up by threads of their own."""

import asyncio
import socket
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

LOOKERS_UP = 4


class ControllerLoop(asyncio.SelectorEventLoop):
    """A loop on which host names that are answered slowly hold up nothing but names.

    A look-up cannot be ended: it goes on in its thread long after who asked has given up. In the threads of
    the loop a handful of drives behind a dead name server would leave none for the disk and the outboxes.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lookers_up = ThreadPoolExecutor(LOOKERS_UP, "look up")

    async def getaddrinfo(self, host: Any, port: Any, **more: int) -> Any:
        """Return the addresses of a host."""
        return await self.run_in_executor(self._lookers_up, partial(socket.getaddrinfo, host, port, **more))

    def close(self) -> None:
        """Close it, and wait for no name."""
        self._lookers_up.shutdown(wait=False, cancel_futures=True)
        super().close()


def run_loop(work: Coroutine[None, None, None]) -> None:
    """Run the work of the controller until it ends."""
    with asyncio.Runner(loop_factory=ControllerLoop) as runner:
        runner.run(work)
