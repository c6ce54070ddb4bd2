"""A page without a browser: its WebSocket, the button that is held on it, and how it is let go."""

import asyncio
from contextlib import suppress
from enum import StrEnum
from typing import NamedTuple

import httpx
import orjson
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed
from websockets.typing import Origin

from tests.patience import PATIENCE_S


class LetGo(StrEnum):
    """How a button that was held is held no more."""

    RELEASED = "button released"
    CLOSED = "tab closed"
    HIDDEN = "page hidden, told by its beacon alone"
    CUT = "network cut, from the last heartbeat"
    KILLED = "browser killed"
    PANEL_FROZEN = "web process frozen"
    CONTROLLER_FROZEN = "controller frozen, by the drive's watchdog"


class Answer(NamedTuple):
    """What came of a heartbeat or of a jog, and when that was heard."""

    at_s: float
    text: str


class Page:
    """One page of one tracker: its WebSocket, and the button that is held on it."""

    def __init__(self, panel_port: int, tracker_id: str) -> None:
        self.tracker_id = tracker_id
        self.answers: dict[str, list[Answer]] = {}
        self.ends: list[Answer] = []
        self._url = f"http://127.0.0.1:{panel_port}"
        self._address = f"ws://127.0.0.1:{panel_port}/live?tracker={tracker_id}"
        self._http = httpx.AsyncClient(base_url=self._url)
        self._measured = asyncio.Event()
        self._socket: ClientConnection | None = None
        self._listening: asyncio.Task[None] | None = None

    async def open(self) -> None:
        """Connect, and measure the connection as a page does before its buttons work."""
        self._measured.clear()
        await self._http.get("/health")
        self._socket = await connect(self._address, origin=Origin(self._url))
        self._listening = asyncio.create_task(self._listen(self._socket))
        await self._send(type="ping", tc=_now_s() * 1000.0)
        async with asyncio.timeout(PATIENCE_S):
            await self._measured.wait()

    async def beat(self, press_id: str, direction: int, sequence: int) -> float:
        """Say that the button is still held, and return when."""
        now_s = _now_s()
        await self._send(
            type="jog", tracker_id=self.tracker_id, press_id=press_id, axis="azimuth", direction=direction,
            speed="slow", sequence=sequence, tc=now_s * 1000.0, rtt_ms=1.0,
        )  # fmt: skip
        return now_s

    async def let_go(self, way: LetGo, press_id: str) -> None:
        """Let go of the button in one way; where the connection goes by that, make a new one."""
        socket = self._socket
        assert socket is not None
        match way:
            case LetGo.RELEASED:
                await self._send(type="end_jog", tracker_id=self.tracker_id, press_id=press_id)
            case LetGo.HIDDEN:
                path = f"/trackers/{self.tracker_id}/end-jog"
                await self._http.post(path, data={"press_id": press_id}, headers={"origin": self._url})
            case LetGo.CLOSED:
                await socket.close(1001)
            case LetGo.KILLED:
                socket.transport.abort()

    async def again(self) -> None:
        """Connect anew if the connection has gone."""
        assert self._listening is not None
        if self._listening.done():
            await self.open()

    async def close(self) -> None:
        """Leave."""
        if self._socket is not None:
            await self._socket.close()
        if self._listening is not None:
            await self._listening
        await self._http.aclose()

    async def _listen(self, socket: ClientConnection) -> None:
        with suppress(ConnectionClosed):
            await self._hear(socket)

    async def _hear(self, socket: ClientConnection) -> None:
        async for text in socket:
            if text.startswith('{"type":"pong"'):
                self._measured.set()
            elif text.startswith('{"type":"jog"'):
                told = orjson.loads(text)
                codes = [reason["code"] for reason in told.get("reasons", ())]
                answer = Answer(_now_s(), " ".join((told["status"], *codes)))
                self.answers.setdefault(told["press_id"], []).append(answer)
            elif text.startswith('{"type":"event"') and '"jog_ended"' in text:
                self.ends.append(Answer(_now_s(), orjson.loads(text)["message"]))

    async def _send(self, **message: object) -> None:
        assert self._socket is not None
        with suppress(ConnectionClosed):
            await self._socket.send(orjson.dumps(message).decode())


def _now_s() -> float:
    return asyncio.get_running_loop().time()
