"""Many short lives of the controller service: each is forked from a process that has loaded its code."""

import multiprocessing
import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from uuid import uuid4

from app.base.settings import Settings
from app.link.client import LinkClient
from app.link.messages import MachineUnreachable
from app.machine.main import run
from app.machine.supervised import end_with_parent
from app.tracker.commands.commands import CommandRejected, Jog
from app.tracker.state.snapshot import SiteSnapshot
from tests.machine.service import Linked, PatientLink
from tests.patience import PATIENCE_S, eventually, pause

FORKING = multiprocessing.get_context("forkserver")
FORKING.set_forkserver_preload([__name__])


def live(settings: Settings) -> None:
    """Be the controller service, with its log beside its data."""
    end_with_parent(os.getppid())
    log = os.open(settings.data_dir / "machine.log", os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    os.dup2(log, 2)
    run(settings)


@dataclass
class Machine(Linked):
    """The controller service in one data folder, without a panel, started and killed again and again."""

    settings: Settings
    link: LinkClient
    data_dir: Path
    lives: list[ForkServerProcess] = field(default_factory=list)

    @classmethod
    def of(cls, data_dir: Path) -> "Machine":
        data_dir.mkdir(parents=True)
        settings = Settings(data_dir=data_dir, log_format="json")
        return cls(settings, PatientLink(settings.link_path), data_dir)

    async def start(self) -> None:
        """Begin the next life; return once it answers."""
        life = FORKING.Process(target=live, args=(self.settings,), daemon=True)
        life.start()
        self.lives.append(life)
        await self.link.start()
        await self.link.watch(frozenset({"T1"}))
        await eventually(lambda: self.link.latest() is not None or not life.is_alive())
        assert life.is_alive(), self.log()

    def kill(self) -> float:
        """Kill it, as nothing can prevent, and return when."""
        life = self.lives[-1]
        life.kill()
        at = time.monotonic()
        life.join(PATIENCE_S)
        return at

    async def forget(self) -> None:
        """Wait until it is known that the machine has gone."""
        await eventually(lambda: self.link.latest() is None)

    async def until_site(
        self, reached: Callable[[SiteSnapshot], object], what: str, *, within_s: float = PATIENCE_S
    ) -> SiteSnapshot:
        """Return what is known of the site once it is so, or fail."""

        def is_so() -> bool:
            latest = self.link.latest()
            return latest is not None and bool(reached(latest))

        try:
            await eventually(is_so, within_s=within_s)
        except TimeoutError as error:
            raise AssertionError(f"{error} Waited for: {what}. {self.link.latest()}") from error
        return self.site

    async def hold(self, tracker_id: str, press: Jog) -> None:
        """Hold a button until it is dead; where a busy computer renewed it too late, press it again."""
        while self.lives[-1].is_alive():
            try:
                await self.ask(press, tracker_id)
                press = replace(press, sequence=press.sequence + 1)
            except CommandRejected:
                press = replace(press, press_id=uuid4().hex, sequence=0)
            except MachineUnreachable:
                pass
            await pause()

    @property
    def site(self) -> SiteSnapshot:
        """Return what is known of the site now."""
        latest = self.link.latest()
        assert latest is not None, self.log()
        return latest

    def log(self) -> str:
        """Return the end of what it wrote."""
        return (self.data_dir / "machine.log").read_text()[-2000:]

    async def stop(self) -> None:
        """End it properly."""
        await self.link.close()
        for life in self.lives[-1:]:
            life.terminate()
            life.join(PATIENCE_S)
