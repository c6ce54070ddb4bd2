"""From a pressed key to one order of the machine, and back to the page with what came of it."""

from datetime import datetime
from typing import Annotated

from fastapi import Depends, Form, Header
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from app.base.instants import read_instant
from app.base.message import told_by
from app.base.permission import Permission
from app.link.messages import SiteCommand
from app.tracker.commands.commands import Command
from app.web.http.build_id import refuse_outdated
from app.web.http.errors import NotAcceptable
from app.web.http.paths import own_path
from app.web.shell.contexts import Outcome
from app.web.shell.deps import order_of, panel, principal
from app.web.shell.render import page, wants_block


class Press:
    """The press of one key: its one-time id, when it was pressed by the machine's clock, and where."""

    def __init__(
        self,
        request: Request,
        key: Annotated[str | None, Form(max_length=64)] = None,
        issued_at: Annotated[str, Form(max_length=40)] = "",
        back: Annotated[str, Form(max_length=300)] = "/",
        epoch: Annotated[str, Form(max_length=20)] = "",
        page: Annotated[str, Form(max_length=100)] = "",
        x_page: Annotated[str, Header(max_length=100)] = "",
    ) -> None:
        self.request = request
        self.key = key or None
        self.issued_at = _instant(issued_at)
        self.back = own_path(back)
        self.mark = x_page or page
        self.epoch = int(epoch) if epoch.isascii() and epoch.isdigit() else None

    async def send(self, command: Command | SiteCommand, tracker_id: str | None = None) -> None:
        """Send one order to the machine; every refusal is raised. A page that is outdated may only stop."""
        who = principal(self.request)
        if command.spec.needs is not Permission.STOP:
            refuse_outdated(self.mark, panel(self.request).machine.latest())
        order = order_of(who, command, tracker_id, self.key, self.issued_at, self.epoch)
        try:
            await panel(self.request).machine.execute(order)
        except ValueError as error:
            raise NotAcceptable(told_by(error)) from error

    def answer(self, done: str = "") -> Response:
        """Say below the key what was done, or return to the page where htmx is not at work.

        Nothing is said of what the tracker's own messages tell, with who did it and when, until it is over.
        """
        if wants_block(self.request):
            if not done:
                return HTMLResponse("")
            return page(self.request, Outcome(done=done, detail="", reasons=()))
        return RedirectResponse(self.back, 303)


PressDep = Annotated[Press, Depends()]


def _instant(text: str) -> datetime | None:
    try:
        at = read_instant(text)
    except ValueError:
        return None
    return at if at.tzinfo else None
