"""Pages that look on: `viewer.py PORT VIEWERS JOINED_S LASTS_S`; prints how late each state came."""

import asyncio
import gc
import re
import sys
import time
from datetime import datetime

import orjson
from websockets.asyncio.client import connect
from websockets.exceptions import WebSocketException
from websockets.typing import Origin

STAMP = re.compile(r'"at":"([^"]+)"')


async def _view(port: int, after_s: float, late_ms: list[float]) -> bool:
    """Read for as long as it is let; return whether it was served at all."""
    served, url = False, f"http://127.0.0.1:{port}"
    loop = asyncio.get_running_loop()
    try:
        async with connect(
            url.replace("http", "ws") + "/live",
            origin=Origin(url),
            compression=None,
            ping_interval=None,
            open_timeout=None,
        ) as page:
            async for text in page:
                now, stamp = time.time(), STAMP.search(str(text))
                served = True
                if stamp is not None and loop.time() >= after_s and '"type":"state"' in str(text)[:40]:
                    late_ms.append((now - datetime.fromisoformat(stamp[1]).timestamp()) * 1000.0)
    except (OSError, WebSocketException):
        return served
    return served


async def _views(port: int, viewers: int, joined_s: float, lasts_s: float) -> None:
    loop, late_ms = asyncio.get_running_loop(), list[float]()
    gc.freeze()
    begun_s = loop.time()
    views = []
    for number in range(viewers):
        await asyncio.sleep(max(0.0, begun_s + number * joined_s / 2 / viewers - loop.time()))
        views.append(asyncio.create_task(_view(port, begun_s + joined_s, late_ms)))
    await asyncio.sleep(max(0.0, begun_s + joined_s + lasts_s - loop.time()))
    served = len(late_ms) > 0 and sum(not view.done() or view.result() for view in views)
    sys.stdout.buffer.write(orjson.dumps({"served": int(served), "late_ms": late_ms}))
    sys.stdout.flush()
    for view in views:
        view.cancel()
    await asyncio.gather(*views, return_exceptions=True)


if __name__ == "__main__":
    PORT, VIEWERS, JOINED_S, LASTS_S = sys.argv[1:]
    asyncio.run(_views(int(PORT), int(VIEWERS), float(JOINED_S), float(LASTS_S)))
