"""ETag and If-Match on settings: a change of what has changed since it was read is refused with 412."""

from collections.abc import AsyncIterator, Callable
from hashlib import sha256
from typing import Annotated, Any

from fastapi import Depends, Header
from fastapi.params import Depends as Dependency
from pydantic_core import to_json
from starlette.responses import Response

from app.base.message import N_
from app.tracker.memory.memory import SiteState
from app.web.http.problems import SettingsChanged
from app.web.shell.deps import MachineDep

LATER = N_("These settings have changed since you read them. Read them again, then repeat the change.")
IfMatch = Annotated[
    str | None,
    Header(
        alias="If-Match",
        max_length=1000,
        description="`ETag` of the settings as they were read: when they have changed since, the request is "
        "refused with 412. Left out: what is there is replaced.",
    ),
]
Settings = Callable[..., Any]


def of_site(part: Callable[[SiteState], Any]) -> Settings:
    """Return what reads one kind of settings of the site."""

    async def settings(machine: MachineDep) -> Any:
        return part((await machine.detail()).site)

    return settings


def tag_of(settings: Any) -> str:
    """Return what stands for settings: the same for the same, another for all others."""
    return f'"{sha256(to_json(settings)).hexdigest()[:32]}"'


def tagged(settings: Settings) -> Dependency:
    """Return what has a call tell the tag of the settings that it reads."""

    async def tell(response: Response, now: Annotated[Any, Depends(settings)]) -> None:
        response.headers["ETag"] = tag_of(now)

    return Dependency(tell)


async def _alone() -> AsyncIterator[None]:
    """Be held by one request at a time."""
    yield


ALONE = Depends(_alone, scope="function", max_concurrency=1)
"""Shared by all: between the check and the change no other request changes settings."""


def unless_changed(settings: Settings) -> Dependency:
    """Return what refuses a change of settings that are not those that the request names."""

    async def check(
        alone: Annotated[None, ALONE], now: Annotated[Any, Depends(settings)], if_match: IfMatch = None
    ) -> None:
        if if_match is not None and not _names(if_match, tag_of(now)):
            raise SettingsChanged(LATER)

    return Dependency(check)


def _names(if_match: str, tag: str) -> bool:
    return if_match.strip() == "*" or tag in (one.strip() for one in if_match.split(","))
