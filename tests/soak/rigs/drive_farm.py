"""Many simulated drives in one process, and what each is told to do, read over a connection of its own."""

import asyncio
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from struct import pack, unpack_from

from app.drives.profile import load_profile
from tests.e2e.product import end

FARM = """
import asyncio
import gc
import signal
import sys
from app.base.clock import SystemClock
from app.drives.profile import load_profile
from app.simulation.servers.sim_server import serve
from app.simulation.simulated import SimulatedDrive
from app.tracker.settings.config import TrackerConfig

async def main():
    clock, profile, servers = SystemClock(), load_profile("simulated-plc"), []
    for number in range(int(sys.argv[1])):
        drive = SimulatedDrive(TrackerConfig(f"T{number}", "Held"), clock)
        servers.append(await serve("127.0.0.1", 0, profile, drive, clock))
    print(*(port for _, port in servers), flush=True)
    gc.freeze()
    ended = asyncio.Event()
    asyncio.get_running_loop().add_signal_handler(signal.SIGTERM, ended.set)
    await ended.wait()
    for server, _ in servers:
        await server.close()

asyncio.run(main())
"""

LOOK_EVERY_S = 0.004
GIVE_UP_S = 2.0
FIFO_PRIORITY = 5
PROFILE = load_profile("simulated-plc")
STATUS = PROFILE.registers["status"].address
MOTION = PROFILE.registers["azimuth_motion"].address
TRIPPED = 1 << PROFILE.bits["status"]["watchdog_tripped"]
HALT, VELOCITY = 0, 1


class Watched:
    """What one simulated drive is told to do, read over a connection of its own."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        self._reader, self._writer = reader, writer

    @classmethod
    async def at(cls, port: int) -> "Watched":
        """Connect."""
        return cls(*await asyncio.open_connection("127.0.0.1", port))

    async def turns(self) -> bool:
        """Return whether the azimuth axis is told to turn and does not ramp down for want of a keep-alive."""
        count = MOTION + 3 - STATUS
        self._writer.write(pack(">HHHBBHH", 1, 0, 6, 1, 3, STATUS, count))
        reply = await self._reader.readexactly(9 + 2 * count)
        (status,) = unpack_from(">H", reply, 9)
        motion, setpoint = unpack_from(">Hi", reply, 9 + 2 * (MOTION - STATUS))
        told = motion != HALT and not (motion == VELOCITY and setpoint == 0)
        return bool(told and not status & TRIPPED)

    async def until_told(self) -> float:
        """Return when the axis was first seen to be told to rest."""
        loop = asyncio.get_running_loop()
        give_up = loop.time() + GIVE_UP_S
        while await self.turns():
            assert loop.time() < give_up, "the axis was not told to stop"
            await asyncio.sleep(LOOK_EVERY_S)
        return loop.time()

    async def close(self) -> None:
        """Let go of the connection."""
        self._writer.close()
        await self._writer.wait_closed()


@contextmanager
def farm(drives: int) -> Iterator[Sequence[int]]:
    """Run so many simulated drives, and yield their ports."""
    process = subprocess.Popen([sys.executable, "-c", FARM, str(drives)], stdout=subprocess.PIPE)
    assert process.stdout is not None
    try:
        keep_punctual(process.pid)
        yield [int(word) for word in process.stdout.readline().split()]
    finally:
        end(process)
        process.stdout.close()


def keep_punctual(process_id: int) -> None:
    """Let other programs not delay the drives and the watch: only the product is measured."""
    with suppress(OSError):
        policy = os.SCHED_FIFO | os.SCHED_RESET_ON_FORK
        os.sched_setscheduler(process_id, policy, os.sched_param(FIFO_PRIORITY))
