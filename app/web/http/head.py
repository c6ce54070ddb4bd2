"""HEAD of every address that GET takes: the same status and headers, and no body."""

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send


class HeadAsGet:
    """Asks the panel as GET and ends its work once the headers are known: a stream would go on for ever."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass everything but HEAD on as it is."""
        if scope["type"] != "http" or scope["method"] != "HEAD":
            await self._app(scope, receive, send)
            return
        answered = asyncio.Event()

        async def only_the_head(message: Message) -> None:
            await send(message)
            await send({"type": "http.response.body", "body": b""})
            answered.set()
            await asyncio.Event().wait()

        serving = asyncio.ensure_future(self._app({**scope, "method": "GET"}, receive, only_the_head))
        waiting = asyncio.create_task(answered.wait())
        try:
            await asyncio.wait({serving, waiting}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            serving.cancel()
            waiting.cancel()
            ended, _ = await asyncio.gather(serving, waiting, return_exceptions=True)
        if not answered.is_set() and isinstance(ended, Exception):
            raise ended
