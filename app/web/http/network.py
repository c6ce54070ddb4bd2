"""The panel's own address changed while it is in use: served on trial, kept only when confirmed there.

What was in force is on the disk before anything changes, and a trial is in memory alone: whatever ends this
process in between, the next one serves what was in force.
"""

import asyncio
import hmac
import ipaddress
import secrets
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime, timedelta

from app.access.authenticator import Keeper
from app.access.principal import Principal
from app.base.clock import Clock, set_or_at
from app.base.logs import get_logger
from app.base.message import N_, say
from app.base.network import Network, write_network
from app.base.settings import LOOPBACK, Settings
from app.web.http.network_check import addresses_here, prepared, refuse_impossible

CONFIRM_WITHIN = timedelta(seconds=60)
FAREWELL = timedelta(seconds=2)
"""The page that says where to go needs a moment to load what it shows."""

NOT_CONFIRMED = N_("The new settings were not confirmed at the new address within 60 s.")
NOT_WRITTEN = N_("The new settings could not be written to the disk.")
NOT_SERVED = N_("Heliopanel could not start at the new address.")

log = get_logger()


class NetworkBusy(Exception):
    """A change of the network is under way; the text says what to do first."""


class NotOnTrial(Exception):
    """There is nothing to confirm, or not with this ticket; the text says what became of it."""


@dataclass(frozen=True, slots=True)
class Trial:
    """Settings that are tried: what was in force before, who tries them, and the ticket that keeps them."""

    wanted: Network
    before: Settings
    by: Principal
    ticket: str


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of the last trial."""

    wanted: Network
    by: Principal
    why: str


@dataclass(frozen=True, slots=True)
class Stage:
    """What the panel serves: settings for good or on trial, what of them the environment fixes."""

    settings: Settings
    fixed: frozenset[str] = frozenset()
    trial: Trial | None = None
    outcome: Outcome | None = None

    def back(self, why: str) -> "Stage":
        """Return the stage after a trial that was not kept."""
        if self.trial is None:
            return self
        return Stage(self.trial.before, self.fixed, outcome=Outcome(self.trial.wanted, self.trial.by, why))


def _nowhere() -> None:
    """Restart nothing: this panel is served by somebody else."""


class NetworkDesk:
    """Takes a change of the network, tries it, keeps it or goes back; `restart` ends this serving."""

    def __init__(self, stage: Stage, clock: Clock, keeper: Keeper) -> None:
        self.restart: Callable[[], None] = _nowhere
        self.following: Stage | None = None
        self._stage = _pinned(stage)
        self._clock = clock
        self._keeper = keeper
        self._until = clock.now() + CONFIRM_WITHIN
        self._changed = asyncio.Event()
        self._busy = False

    @property
    def in_force(self) -> Network:
        """Return what is served now, on trial or not."""
        return self._stage.settings.network

    @property
    def fixed(self) -> frozenset[str]:
        """Return what the environment sets, which no page changes."""
        return self._stage.fixed

    @property
    def outcome(self) -> Outcome | None:
        """Return what became of the last trial, None if it was kept or there was none."""
        return self._stage.outcome

    @property
    def confirm_until(self) -> datetime | None:
        """Return until when what is served must be confirmed, None if it need not."""
        return self._until if self._stage.trial is not None else None

    async def propose(self, wanted: Network, by: Principal) -> Trial:
        """Serve this on trial in a moment; raise `NetworkRefused` or `NetworkBusy` where that cannot be.

        What is in force is written down first, so that no crash and no power cut can leave anything else.
        """
        if self._stage.trial is not None or self._busy:
            raise NetworkBusy(
                N_("A network change is being tested. Confirm the change, or wait until the test ends.")
            )
        before, self._busy = self._stage.settings, True
        try:
            trying = await asyncio.to_thread(self._prepare, wanted, before)
            trial = Trial(wanted, before, by, secrets.token_urlsafe(32))
            await self._note("network_tried", by, told(before.network, wanted))
            self.following = Stage(trying, self._stage.fixed, trial)
        finally:
            self._busy = self.following is not None
        self._changed.set()
        return trial

    def _prepare(self, wanted: Network, before: Settings) -> Settings:
        has_administrator = self._keeper.book.has_administrator
        refuse_impossible(before, wanted, self._stage.fixed, has_administrator=has_administrator)
        write_network(before.data_dir, before.network)
        return prepared(before, wanted, self._clock.system_time())

    async def keep(self, ticket: str, address: str) -> None:
        """Keep what is served on trial, or raise `NotOnTrial`; whoever has the ticket has reached it."""
        trial = self._stage.trial
        if trial is None or self.following is not None:
            raise NotOnTrial(
                N_("There is nothing to confirm: the change is already confirmed, or its test has ended.")
            )
        if not hmac.compare_digest(ticket.encode(), trial.ticket.encode()):
            raise NotOnTrial(
                N_("This is not the address shown on the Network page. Open the address shown there.")
            )
        tried, settings = self._stage, self._stage.settings
        self._stage = Stage(settings, tried.fixed)
        try:
            await asyncio.to_thread(write_network, settings.data_dir, settings.network)
        except OSError as error:
            self.following = tried.back(NOT_WRITTEN)
            self.restart()
            raise NotOnTrial(
                say("{not_written} Heliopanel returns to its previous address.", not_written=NOT_WRITTEN)
            ) from error
        self._changed.set()
        log.info("network_kept", actor=trial.by.name, address=address)
        await self._note("network_kept", trial.by, told(trial.before.network, trial.wanted))

    async def run(self) -> None:
        """Go back where nobody confirms in time, and restart for what is proposed; until cancelled."""
        telling = asyncio.create_task(self._tell_outcome())
        try:
            await self._watch()
        finally:
            await asyncio.gather(telling, return_exceptions=True)

    async def _watch(self) -> None:
        if self._stage.trial is not None:
            await set_or_at(self._changed, self._clock, self._until)
        if self._stage.trial is not None:
            self.following = self._stage.back(NOT_CONFIRMED)
        else:
            while self.following is None:
                self._changed.clear()
                await self._changed.wait()
            await self._clock.sleep_until(self._clock.now() + FAREWELL)
        self.restart()

    async def _tell_outcome(self) -> None:
        if (outcome := self._stage.outcome) is not None:
            log.warning("network_rolled_back", why=outcome.why)
            what = f"{told(None, outcome.wanted)}: {outcome.why}"
            await self._note("network_rolled_back", outcome.by, what)

    async def _note(self, action: str, by: Principal, result: str) -> None:
        now = self._clock.system_time()
        await self._keeper.do(lambda: self._keeper.accounts.record(by, action, "network", now, result))


def _pinned(stage: Stage) -> Stage:
    """Return the stage with https as it is served: a certificate that is made later changes nothing of it."""
    settings = stage.settings
    return replace(stage, settings=settings.model_copy(update={"tls": settings.certificate is not None}))


def told(before: Network | None, after: Network) -> str:
    """Return what changes, for the record: only what differs where both are known."""
    names = Network.__dataclass_fields__
    if before is None:
        return ", ".join(f"{name} {_plain(getattr(after, name))}" for name in names)
    changes = {name: (getattr(before, name), getattr(after, name)) for name in names}
    return ", ".join(
        f"{name} {_plain(old)} -> {_plain(new)}" for name, (old, new) in changes.items() if old != new
    )


def _plain(value: object) -> str:
    return " ".join(map(str, value)) or "none" if isinstance(value, tuple) else str(value).lower()


def ways(network: Network, here: str) -> tuple[str, ...]:
    """Return the addresses at which a panel with this network is found, first by the name used now."""
    if network.host in LOOPBACK:
        names = [here if here in LOOPBACK else network.host]
    elif ipaddress.ip_address(network.host).is_unspecified:
        names = [here, *(name for name in addresses_here() if ":" not in name), *network.allowed_hosts]
    else:
        names = [network.host, *network.allowed_hosts]
    scheme, standard = ("https", 443) if network.tls else ("http", 80)
    port = "" if network.port == standard else f":{network.port}"
    found = (f"{scheme}://{f'[{name}]' if ':' in name else name}{port}" for name in names if name)
    return tuple(dict.fromkeys(found))
