"""A label for the cabinet: the tracker's name and a QR code that opens the buttons that move it."""

import ipaddress
from typing import Annotated
from urllib.parse import quote, urlsplit

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_
from app.base.permission import Permission
from app.web.features.records.qr import qr_path
from app.web.features.records.record_contexts import LabelPage
from app.web.features.records.record_orders import require_tracker
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import PanelDep
from app.web.shell.forms import Typed
from app.web.shell.frame import tracker_frame
from app.web.shell.render import page

router = page_router(prefix="/trackers/{tracker_id}/label")
LONGEST_ADDRESS = 120
WRONG = N_("Address: type how tablets reach this panel, such as https://heliopanel.local:8000.")


@router.get("")
@needs(Permission.READ)
async def label(
    request: Request,
    tracker_id: str,
    built: PanelDep,
    address: Annotated[str, Query(max_length=200)] = "",
) -> Response:
    """Show the label as it will be printed; the address in its code can be changed."""
    await require_tracker(built, tracker_id)
    here = f"{request.url.scheme}://{request.url.netloc}"
    base = _base(address) if address else here
    typed = Typed({"address": address or here})
    if base is None:
        typed.errors["address"] = WRONG
    url = f"{base or here}/trackers/{quote(tracker_id)}/mast"
    path, size = qr_path(url)
    frame = tracker_frame(
        request, tracker_id, N_("Label"), back=Link(N_("Record"), f"/trackers/{tracker_id}/record")
    )
    context = LabelPage(
        frame=frame,
        form=typed.form(("address",)),
        url=url,
        path=path,
        size=size,
        is_loopback=_is_loopback(url),
        printed_at=frame.site.at if frame.site else None,
    )
    return page(request, context, status=422 if typed.errors else 200)


def _base(address: str) -> str | None:
    """Return scheme, host and port of an address, None where it is none."""
    try:
        parts = urlsplit(address.strip())
        port = f":{parts.port}" if parts.port else ""
    except ValueError:
        return None
    host = parts.hostname or ""
    if parts.scheme not in ("http", "https") or not host or len(address) > LONGEST_ADDRESS:
        return None
    if not all(letter.isalnum() or letter in "-.:" for letter in host):
        return None
    return f"{parts.scheme}://{f'[{host}]' if ':' in host else host}{port}"


def _is_loopback(url: str) -> bool:
    host = urlsplit(url).hostname or ""
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"
