"""A stage with the controller itself behind the panel, and simulated drives that ramp, on the same clock."""

import contextlib
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, cast

from playwright.sync_api import Browser

from app.base.clock import VirtualClock
from app.base.settings import Settings
from app.link.messages import Order
from app.simulation.simulated import SimulatedDrive
from app.site.site import Site
from app.tracker.memory.memory import SiteState
from app.tracker.settings.config import TrackerConfig
from app.tracker.state.snapshot import ActivityName, Event, EventKind, SiteSnapshot, Snapshot
from app.web.main import create_app
from tests.access.fake_hasher import FakeHasher
from tests.browser.conftest import Served, running
from tests.browser.page_clock import NOON, Lines, Stage
from tests.fake_store import FakeReader
from tests.fakes import FakeMachine
from tests.site.plant import FIRST


class Recorded:
    """A site that keeps every order it was given."""

    def __init__(self, site: Site, clock: VirtualClock) -> None:
        self.site, self.clock = site, clock
        self.orders: list[Order] = []

    async def execute(self, order: Order) -> SiteSnapshot:
        """Have the site carry an order out."""
        self.orders.append(order)
        return await self.site.execute(order)

    def __getattr__(self, name: str) -> Any:
        return getattr(self.site, name)


@dataclass
class ServedSite(Served):
    """Serves the panel of a site, which lives as long as it is served."""

    drives: dict[str, SimulatedDrive] = field(default_factory=dict)
    events: list[Event] = field(default_factory=list)

    async def _move(self) -> None:
        site = cast("Recorded", self.machine).site
        await site.start()
        try:
            async for update in site.updates():
                self.events.extend(update.events)
        finally:
            await site.close()


@dataclass
class SiteStage(Stage):
    """The stage, with what the controller and the drives know."""

    served: ServedSite = field(kw_only=True)

    @property
    def tracker(self) -> Snapshot:
        """Return the tracker as the controller sees it at its last tick."""
        latest = self.plant.machine.latest()
        assert latest is not None
        return latest.trackers[0]

    @property
    def speed_dps(self) -> float:
        """Return how fast the azimuth axis really turns at this instant."""

        async def seen() -> float:
            return self.served.drives["T1"].observe().azimuth.velocity_dps

        return float(self.ask(seen()))

    @property
    def is_jogging(self) -> bool:
        """Return whether the controller turns an axis while somebody holds a key."""
        return self.tracker.activity is ActivityName.JOGGING

    def happened(self, kind: EventKind) -> list[Event]:
        """Return the events of a kind, as the journal has them."""
        return [event for event in self.served.events if event.kind is kind]


@contextlib.contextmanager
def staged_site(browser: Browser) -> Iterator[SiteStage]:
    """Serve the panel of one tracker, T1, which knows neither its place nor its home position."""
    clock = VirtualClock(NOON)
    drives: dict[str, SimulatedDrive] = {}

    def drive(config: TrackerConfig) -> SimulatedDrive:
        return drives.setdefault(config.tracker_id, SimulatedDrive(config, clock))

    site = Site(clock, drive, SiteState(), (FIRST,))
    machine = cast("FakeMachine", Recorded(site, clock))
    folder = Path(tempfile.mkdtemp(prefix="heliopanel-stage-"))
    app = create_app(
        Settings(data_dir=folder), machine=machine, reader=FakeReader(), clock=clock, hasher=FakeHasher()
    )
    lines = Lines()
    served = ServedSite(machine, app, around=lines.around, drives=drives)
    with contextlib.ExitStack() as stack:
        stack.callback(shutil.rmtree, folder, ignore_errors=True)
        plant = stack.enter_context(running(served))
        stage = SiteStage(browser, plant, clock, lines, served=served)
        stage.begin()
        yield stage
        stage.close()
