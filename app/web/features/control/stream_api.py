"""Server-sent events for integrators: a full snapshot first, then every change."""

import asyncio
from contextlib import suppress
from typing import Annotated

from fastapi import Header, Query
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from app.base.logs import get_logger
from app.base.message import N_
from app.base.permission import Permission
from app.link.messages import MachineUnreachable
from app.tracker.state.snapshot import EventKind
from app.web.api.base import Responses, api_router
from app.web.http.needs import needs
from app.web.live.hub import Hub, TooManyViewers
from app.web.live.viewers import Message, TooSlow, Viewer, Wanted, pump
from app.web.shell.deps import PanelDep, PrincipalDep

log = get_logger()
router = api_router(tags=["stream"])

RESYNC = Message("resync", '{"type":"resync","detail":"Events were missed; read /api/v1/journal for them."}')
STREAM: Responses = {
    200: {
        "description": "Server-sent events: `snapshot`, `event`, `machine_lost`, `resync`.",
        "content": {"text/event-stream": {"schema": {"type": "string"}}},
    }
}


class EventStream(Response):
    """A viewer's messages as server-sent events, until it goes or does not take them."""

    media_type = "text/event-stream"

    def __init__(self, hub: Hub, viewer: Viewer) -> None:
        super().__init__(headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"})
        del self.headers["content-length"]
        self._hub = hub
        self._viewer = viewer

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Serve until the reader disconnects."""
        try:
            await send({"type": "http.response.start", "status": 200, "headers": self.raw_headers})
            await self._serve(receive, send)
        finally:
            self._hub.leave(self._viewer)

    async def _serve(self, receive: Receive, send: Send) -> None:
        async def put(message: Message) -> None:
            await send({"type": "http.response.body", "body": framed(message), "more_body": True})

        sending = asyncio.create_task(pump(self._viewer, put, self._hub.patience))
        leaving = asyncio.create_task(_gone(receive))
        closing = asyncio.create_task(self._hub.closing.wait())
        tasks = (sending, leaving, closing)
        try:
            await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for task in tasks:
                task.cancel()
            ended = await asyncio.gather(*tasks, return_exceptions=True)
        if isinstance(ended[0], TooSlow):
            log.warning("a reader of the event stream was too slow and is dropped")
            return
        with suppress(OSError):
            await send({"type": "http.response.body", "body": b""})


async def _gone(receive: Receive) -> None:
    while (await receive())["type"] != "http.disconnect":
        pass


def framed(message: Message) -> bytes:
    """Return a message as a server-sent event."""
    place = f"id: {message.mark}\n" if message.mark else ""
    return f"event: {message.name}\n{place}data: {message.text}\n\n".encode()


@router.get("/stream", summary="Live snapshots and events", response_class=Response, responses=STREAM)
@needs(Permission.READ, lasts=True, ticketed=True)
async def stream_events(
    panel: PanelDep,
    who: PrincipalDep,
    tracker_id: Annotated[str | None, Query(max_length=64, description="Only this tracker.")] = None,
    kind: Annotated[list[EventKind] | None, Query(description="Only events of these kinds.")] = None,
    last_event_id: Annotated[str | None, Header(alias="Last-Event-ID", max_length=64)] = None,
) -> Response:
    """Send the whole state, what was missed since `Last-Event-ID`, and from then on every change."""
    wanted = Wanted(tracker_id, frozenset(kind or ()), trackers=who.trackers, always_whole=True)
    try:
        viewer = panel.hub.join(wanted)
    except TooManyViewers as error:
        raise MachineUnreachable(
            N_("Heliopanel has reached its limit of event streams; try again later.")
        ) from error
    for message in _missed(panel.hub, wanted, last_event_id):
        viewer.tell(message)
    return EventStream(panel.hub, viewer)


def _missed(hub: Hub, wanted: Wanted, mark: str | None) -> list[Message]:
    if mark is None:
        return []
    missed = hub.missed(mark, wanted)
    return [RESYNC] if missed is None else missed
