"""A recorded trace as a process of its own that answers on Modbus TCP as the device did."""

import asyncio
import sys
from collections.abc import Sequence

from app.modbus.trace import Exchange, Replay, ReplayDevice
from app.simulation.servers.sim_server import Doors, ending, serve_doors


def run_trace_server(tcp: str, exchanges: Sequence[Exchange]) -> None:
    """Serve the answers of a trace on `HOST:PORT` until SIGTERM or SIGINT; port 0 takes a free one."""
    asyncio.run(_run(tcp, exchanges))


async def _run(tcp: str, exchanges: Sequence[Exchange]) -> None:
    ended = ending()
    replay = Replay(exchanges)
    devices = {unit: ReplayDevice(replay, unit) for unit in replay.units}
    servers, places = await serve_doors(Doors(tcp), devices)
    sys.stdout.write(
        f"Recorded answers on {places[0]}, unit {', '.join(map(str, devices))}. Ctrl-C ends it.\n"
    )
    sys.stdout.flush()
    await ended.wait()
    for server in servers:
        await server.close()
