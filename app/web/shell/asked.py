"""A page about one tracker shows which of its buttons work: the controller is asked before it is made."""

import re
from contextlib import suppress

from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from app.base.permission import Permission
from app.link.messages import MachineUnreachable, UnknownTracker
from app.tracker.state.snapshot import Snapshot
from app.web.shell.deps import panel, principal

ABOUT_ONE = re.compile(r"/trackers/(?P<tracker_id>[^/]+)(/|$)")
ASKED = "tracker_now"


class AskFirst:
    """Puts the tracker as it stands now beside a request for its page; without an answer the page does."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Ask for whoever may read it, then go on."""
        about = ABOUT_ONE.match(scope["path"]) if scope["type"] == "http" else None
        if about is not None and scope["method"] == "GET":
            request, tracker_id = Request(scope), about["tracker_id"]
            if principal(request).may(Permission.READ, tracker_id):
                with suppress(MachineUnreachable, UnknownTracker):
                    scope["state"][ASKED] = await panel(request).machine.tracker(tracker_id)
        await self._app(scope, receive, send)


def asked(request: Request) -> Snapshot | None:
    """Return the tracker that was asked for, None where nobody asked."""
    found: Snapshot | None = request.scope.get("state", {}).get(ASKED)
    return found
