"""Where the panel listens: changed on trial, confirmed from the new address."""

from datetime import datetime
from typing import Annotated

from pydantic import Field
from starlette.requests import Request

from app.base.network import Network
from app.base.permission import Permission
from app.web.api.base import CHANGED, REFUSED, TAGGED, Input, Output, api_router
from app.web.api.tags import tagged, unless_changed
from app.web.http.needs import needs
from app.web.http.network import CONFIRM_WITHIN, ways
from app.web.shell.deps import PanelDep, PrincipalDep

router = api_router(prefix="/network", tags=["site"])

Name = Annotated[str, Field(min_length=1, max_length=253)]


class NetworkInput(Input):
    """Where the panel shall listen."""

    host: str = Field(
        min_length=1, max_length=60, description="Address to listen on.", examples=["127.0.0.1"]
    )
    port: int = Field(ge=1, le=65535, examples=[8443])
    allowed_hosts: tuple[Name, ...] = Field((), max_length=20, description="Other names of the panel.")
    trusted_proxies: tuple[Name, ...] = Field(
        (), max_length=20, description="Addresses or networks of reverse proxies that are believed."
    )
    tls: bool = Field(description="Serve https; a certificate is made where there is none.")


class NetworkState(Output):
    """Where the panel listens."""

    host: str
    port: int
    allowed_hosts: tuple[str, ...]
    trusted_proxies: tuple[str, ...]
    tls: bool
    fixed: tuple[str, ...] = Field(description="What the environment sets and this call cannot change.")
    confirm_until: datetime | None = Field(description="Until when it must be confirmed; None: it is kept.")
    last_rollback: str = Field(description="Why the last change was taken back; empty where none was.")


class NetworkTrial(Output):
    """A change that is tried from now on."""

    addresses: tuple[str, ...] = Field(description="Where the panel is found in a moment.")
    ticket: str = Field(description="Send it to /api/v1/network/confirmation at the new address.")
    confirm_within_s: float = Field(description="After this time the panel goes back to what was in force.")


class Confirmation(Input):
    """The ticket of a change."""

    ticket: str = Field(min_length=1, max_length=100)


def network_now(built: PanelDep) -> Network:
    """Return the settings that are in force."""
    return built.network.in_force


@router.get("", summary="Where the panel listens", responses=TAGGED, dependencies=[tagged(network_now)])
@needs(Permission.ADMINISTER)
def read_network(built: PanelDep) -> NetworkState:
    """Return address, port, names, proxies and whether it serves https."""
    return _state(built)


@router.put(
    "",
    status_code=202,
    summary="Change where the panel listens",
    responses=CHANGED | REFUSED,
    dependencies=[unless_changed(network_now)],
)
@needs(Permission.ADMINISTER, proven=True)
async def change_network(
    change: NetworkInput, request: Request, built: PanelDep, who: PrincipalDep
) -> NetworkTrial:
    """Try this; it is taken back after 60 s unless it is confirmed at the new address."""
    wanted = Network(**change.model_dump())
    trial = await built.network.propose(wanted, who)
    return NetworkTrial(
        addresses=ways(wanted, request.url.hostname or ""),
        ticket=trial.ticket,
        confirm_within_s=CONFIRM_WITHIN.total_seconds(),
    )


@router.post("/confirmation", summary="Keep a change of the network", responses=REFUSED)
@needs(Permission.OPEN)
async def confirm_network(given: Confirmation, built: PanelDep, who: PrincipalDep) -> NetworkState:
    """Keep what is tried; whoever has its ticket and reaches the new address may, without signing in."""
    await built.network.keep(given.ticket, who.address)
    return _state(built)


def _state(built: PanelDep) -> NetworkState:
    desk, found = built.network, built.network.in_force
    return NetworkState(
        host=found.host,
        port=found.port,
        allowed_hosts=found.allowed_hosts,
        trusted_proxies=found.trusted_proxies,
        tls=found.tls,
        fixed=tuple(sorted(desk.fixed)),
        confirm_until=desk.confirm_until,
        last_rollback=desk.outcome.why if desk.outcome else "",
    )
