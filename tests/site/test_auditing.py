"""Every order is recorded with who gave it, what changed and what came of it; what cannot be is refused."""

import json
from collections.abc import AsyncIterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest

from app.audit.chain import first_break
from app.audit.entry import Entry
from app.link.messages import ConfigureTracker, RenameSite, SetClock, SetLocation, StopAll
from app.link.weather_orders import ReportWeather
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import AuditFilter
from app.store.writer import DatabaseWriter
from app.tracker.commands.commands import CommandRejected, EndJog, Jog, Move, Stop, Track
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation
from app.tracker.state.snapshot import ActivityName
from app.tracker.weather.weather import Weather
from tests.captured_logs import capture_logs
from tests.fault_result import FaultResult
from tests.site.direct_writer import DirectWriter
from tests.site.plant import SAMSUN, SUMMER_NOON, Begun, Plant, make_plant, settle


@dataclass
class Audited:
    """A plant whose orders are recorded in a database in a folder."""

    plant: Plant
    store: DatabaseWriter

    def entries(self) -> list[Entry]:
        return [one.entry for one in self.store.audit(AuditFilter(after=0, limit=1000))]

    def told(self) -> list[tuple[str, str, str]]:
        return [(one.action, one.object, one.result) for one in self.entries()]


@pytest.fixture
async def audited(tmp_path: Path) -> AsyncIterator[Audited]:
    url = f"sqlite:///{tmp_path / 'heliopanel.db'}"
    upgrade(url)
    store = open_writer(url)
    plant = make_plant(writer=DirectWriter(store))
    await plant.start()
    yield Audited(plant, store)
    await plant.close()
    store.close()


async def test_a_setting_tells_who_what_before_and_after(audited: Audited) -> None:
    await audited.plant.ask(RenameSite("South field"), via="session", address="10.0.0.7")
    await audited.plant.ask(RenameSite("North field"), via="session", address="10.0.0.7")
    first, second = audited.entries()
    assert (second.actor, second.via, second.address) == ("technician", "session", "10.0.0.7")
    assert (second.action, second.object, second.result) == ("rename_site", "site", "done")
    assert json.loads(second.given) == {"name": "North field"}
    assert json.loads(second.before) == {"name": "South field"}
    assert json.loads(second.after) == {"name": "North field"}
    assert second.clock_quality == "clock_unset"
    assert second.boot_id == "boot"
    assert second.mono_ms >= first.mono_ms


async def test_what_is_kept_for_undoing_is_no_change_of_its_own(audited: Audited) -> None:
    config = audited.plant.site.model.tracker("T1").config
    await audited.plant.ask(RenameSite("South field"))
    await audited.plant.ask(ConfigureTracker(replace(config, deadband_deg=1.5)))
    await audited.plant.ask(ConfigureTracker(replace(config, deadband_deg=2.0)))
    _, _, entry = audited.entries()
    assert json.loads(entry.before) == {"config.deadband_deg": 1.5}
    assert json.loads(entry.after) == {"config.deadband_deg": 2.0}


async def test_commands_tell_what_they_changed_and_refusals_why(audited: Audited) -> None:
    plant = audited.plant
    with pytest.raises(CommandRejected):
        await plant.ask(Track())
    await plant.track()
    await plant.ask(Stop())
    assert ("take_control", "T1", "done") in audited.told()
    found = [one for one in audited.entries() if one.action != "take_control"]
    assert [one.action for one in found] == [
        "track", "set_location", "set_clock", "home", "release_control", "set_mode", "track", "stop",
    ]  # fmt: skip
    assert found[0].result.startswith("refused: ")
    assert json.loads(found[6].after)["memory.tracking_on"] is True
    assert json.loads(found[7].before)["memory.tracking_on"] is True
    assert found[7].clock_quality == "trusted"
    sealed = audited.store.audit(AuditFilter(after=0))
    assert first_break(one.link() for one in sealed) is None


async def test_a_press_is_recorded_once_and_its_refusals_are_not_repeated(audited: Audited) -> None:
    plant = audited.plant
    await plant.commission()
    for sequence in range(8):
        await plant.ask(Jog("press", Axis.AZIMUTH, 1, sequence=sequence))
        await plant.forward(seconds=0.05)
    await plant.ask(EndJog("press"))
    for number in range(8):
        with pytest.raises(CommandRejected):
            await plant.ask(Jog("press", Axis.AZIMUTH, 1, sequence=number + 8))
    await plant.forward(seconds=0.1)
    presses = [result for action, _, result in audited.told() if action == "jog"]
    assert presses[0] == "done"
    assert len(presses) == 2
    assert presses[1].startswith("refused: ")


async def test_measurements_are_no_decisions(audited: Audited) -> None:
    await audited.plant.ask(ReportWeather(Weather(wind_mps=3.0)))
    assert audited.entries() == []


async def test_what_the_machine_does_later_is_not_put_down_to_the_last_order(audited: Audited) -> None:
    plant = audited.plant
    await plant.commission()
    await plant.ask(Move(Orientation(90.0, 30.0)))
    count = len(audited.entries())
    await plant.until(lambda seen: seen.activity is ActivityName.HOLDING)
    await plant.forward(seconds=5)
    assert len(audited.entries()) == count


@contextmanager
def without_audit(store: DatabaseWriter) -> Any:
    """Let the disk refuse every audit entry, and nothing else, for as long as this lasts."""
    with store._writing.begin() as connection:
        connection.exec_driver_sql(
            "CREATE TRIGGER audit_full BEFORE INSERT ON audit BEGIN SELECT RAISE(ABORT, 'full'); END"
        )
    yield
    with store._writing.begin() as connection:
        connection.exec_driver_sql("DROP TRIGGER audit_full")


class PatientWriter(DirectWriter):
    """Reports what could not be posted as the thread that writes does: to nobody here."""

    def post(self, work: Any) -> bool:
        try:
            return super().post(work)
        except Exception:  # noqa: BLE001 - as the writer's thread, which goes on
            return True


@pytest.mark.fault(71)
async def test_motion_that_cannot_be_recorded_is_refused_and_stop_passes(
    store: DatabaseWriter, fault: FaultResult, begun: Begun
) -> None:
    plant = await begun(writer=PatientWriter(store))
    await plant.commission()
    with without_audit(store):
        with pytest.raises(CommandRejected):
            await plant.ask(Move(Orientation(90.0, 30.0)))
        await plant.forward(seconds=2)
        assert plant.tracker().activity is ActivityName.HOLDING
        with pytest.raises(
            CommandRejected, match="Motion is refused because it cannot be recorded"
        ) as refused:
            await plant.ask(Jog("press", Axis.AZIMUTH, 1))
        fault.prevented("the motion is refused at once")
        fault.shows(str(refused.value))
        with pytest.raises(CommandRejected):
            await plant.ask(SetLocation(SAMSUN, "Europe/Berlin"))
        await plant.ask(Stop())
        await plant.ask(StopAll())
        assert plant.site.model.state.time_zone == "Europe/Istanbul"
    await plant.forward(seconds=5)
    kept = [(one.entry.action, one.entry.result[:8]) for one in store.audit(AuditFilter(after=0))][-5:]
    assert ("stop", "done") in kept
    assert ("stop_all", "done") in kept
    await plant.ask(Move(Orientation(90.0, 30.0)))
    await plant.forward(seconds=1)
    assert plant.tracker().activity is ActivityName.MOVING
    fault.recovers("automatic: once the audit can be written")


async def test_the_last_hash_is_logged_every_ten_minutes(audited: Audited) -> None:
    await audited.plant.ask(RenameSite("North field"))
    with capture_logs() as logs:
        await audited.plant.forward(seconds=3)
        for _ in range(3):
            audited.plant.clock.move_to(audited.plant.clock.now().replace(microsecond=0))
            await settle()
    heads = [one for one in logs if one["event"] == "audit_head"]
    last = audited.store.audit(AuditFilter(limit=1))[0]
    assert [(one["seq"], one["hash"]) for one in heads] == [(1, last.hash)]


async def test_a_refusal_is_recorded_anew_once_the_site_clock_was_set_back(audited: Audited) -> None:
    plant = audited.plant
    for shown in (SUMMER_NOON + timedelta(days=400), SUMMER_NOON):
        await plant.ask(SetClock("manual", shown))
        for _ in range(3):
            with pytest.raises(CommandRejected):
                await plant.ask(Track(), via="sunspec")
            await plant.forward(seconds=1)
    told = [action for action, _, _ in audited.told() if action in ("set_clock", "track")]
    assert told[-2:] == ["set_clock", "track"]
