"""Where the panel listens: changed on trial, confirmed from the new address."""

from datetime import timedelta
from math import ceil
from typing import Annotated

from fastapi import Form, Query
from pydantic import BaseModel
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, told_by
from app.base.network import Network
from app.base.permission import Permission
from app.web.features.security.security_contexts import NetworkPage, NetworkTrialPage
from app.web.http.errors import problem_of
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.http.network import CONFIRM_WITHIN, NetworkBusy, NotOnTrial, ways
from app.web.http.network_check import NetworkRefused, addresses_here
from app.web.shell.deps import PanelDep, PrincipalDep, panel
from app.web.shell.forms import Typed
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/network")

NAMES = ("host", "port", "allowed_hosts", "trusted_proxies", "tls")
FORGET_HTTPS = {"Strict-Transport-Security": "max-age=0"}
Ticket = Annotated[str, Query(max_length=100)]


class NetworkForm(BaseModel):
    """The network as it was typed."""

    host: str = ""
    port: str = ""
    allowed_hosts: str = ""
    trusted_proxies: str = ""
    tls: str = "off"


@router.get("")
@needs(Permission.ADMINISTER, proven=True)
def network(request: Request, built: PanelDep) -> Response:
    """Show where the panel listens."""
    return _answer(request, _texts(built.network.in_force))


@router.post("")
@needs(Permission.ADMINISTER, proven=True)
async def change(
    request: Request, built: PanelDep, who: PrincipalDep, form: Annotated[NetworkForm, Form()]
) -> Response:
    """Try what was typed, and say where to confirm it."""
    typed = Typed(form.model_dump())
    wanted = _read(typed)
    if typed.errors:
        return _answer(request, typed, status=422)
    try:
        trial = await built.network.propose(wanted, who)
    except NetworkRefused as error:
        typed.errors |= {name if name in NAMES else "host": text for name, text in error.errors.items()}
        return _answer(request, typed, status=422)
    except NetworkBusy as error:
        typed.errors["host"] = told_by(error)
        return _answer(request, typed, status=409)
    found = ways(wanted, request.url.hostname or "")
    return _answer(request, typed, found=found, ticket=trial.ticket)


@router.get("/trial")
@needs(Permission.OPEN)
def trial(request: Request, ticket: Ticket = "") -> Response:
    """Show at the new address what is tried, and the key that keeps it."""
    return _trial(request, ticket)


@router.post("/trial")
@needs(Permission.OPEN)
async def confirm(request: Request, built: PanelDep, who: PrincipalDep, ticket: Ticket = "") -> Response:
    """Keep what is tried."""
    try:
        await built.network.keep(ticket, who.address)
    except NotOnTrial as error:
        return _trial(request, "", problem=told_by(error), status=problem_of(error).status)
    return _trial(request, "", kept=True)


def _read(typed: Typed) -> Network:
    texts = {name: text.strip() for name, text in typed.texts.items()}
    return Network(
        host=texts["host"],
        port=typed.whole("port", N_("Port"), 1, 65535),
        allowed_hosts=_words(texts["allowed_hosts"]),
        trusted_proxies=_words(texts["trusted_proxies"]),
        tls=texts["tls"] == "on",
    )


def _words(text: str) -> tuple[str, ...]:
    return tuple(text.replace(",", " ").split())


def _texts(found: Network) -> Typed:
    return Typed(
        {
            "host": found.host,
            "port": str(found.port),
            "allowed_hosts": ", ".join(found.allowed_hosts),
            "trusted_proxies": ", ".join(found.trusted_proxies),
            "tls": "on" if found.tls else "off",
        }
    )


def _answer(
    request: Request, typed: Typed, *, found: tuple[str, ...] = (), ticket: str = "", status: int = 200
) -> Response:
    built = panel(request)
    desk, leaves = built.network, built.network.in_force.tls and typed.texts["tls"] != "on"
    context = NetworkPage(
        frame=site_frame(request, N_("Network")),
        form=typed.form(NAMES),
        in_force=desk.in_force,
        here=addresses_here(),
        fixed=desk.fixed,
        outcome=desk.outcome,
        on_trial=desk.confirm_until is not None,
        has_own_certificate=built.settings.tls_cert_file is None,
        leaves_https=leaves,
        ways=found,
        ticket=ticket,
        seconds=ceil(CONFIRM_WITHIN / timedelta(seconds=1)),
    )
    answer = page(request, context, status=status)
    if ticket and leaves:
        answer.headers.update(FORGET_HTTPS)
    return answer


def _trial(
    request: Request, ticket: str, *, problem: str = "", kept: bool = False, status: int = 200
) -> Response:
    built = panel(request)
    until = built.network.confirm_until
    left = timedelta() if until is None else until - built.clock.now()
    context = NetworkTrialPage(
        frame=site_frame(request, N_("Network")),
        in_force=built.network.in_force,
        ticket=ticket if until is not None else "",
        seconds=max(0, ceil(left / timedelta(seconds=1))),
        problem=problem,
        kept=kept,
    )
    return page(request, context, status=status)
