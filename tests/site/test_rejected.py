"""Stored settings that do not fit at the start: usual ones in their place, and nothing moves."""

import json
from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy import Table, select, update

from app.alarms.alarm import Alarm
from app.base.settings import Settings
from app.link.messages import ConfigureTracker
from app.site.startup import begin
from app.store import tables
from app.store.config_repair import BESIDE
from app.store.connections import transaction, writing_engine
from app.store.documents import SITE, TRACKER
from app.store.engine import open_writer
from app.store.migrations import upgrade
from app.store.store import JournalFilter, KeptAlarm, StoreFailed, StoreUnreadable
from app.store.writer import DatabaseWriter
from app.tracker.commands.commands import CommandRejected, Jog, Stop, Track
from app.tracker.memory.memory import HomeTrust, MetStation, SiteState, TrackerMemory, TrackerState
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import Orientation, TrackerConfig
from app.tracker.state.snapshot import EventKind
from tests.fault_result import FaultResult
from tests.site.plant import SAMSUN, Plant, make_plant
from tests.store.tracked_day import day_info

NOW = datetime(2027, 6, 21, 9, 0, tzinfo=UTC)
KEPT = TrackerState(
    TrackerConfig("T1", "North", deadband_deg=0.7),
    TrackerMemory(tracking_on=True, home=HomeTrust(NOW, "Ada", "set manually", 3)),
)
SITE_KEPT = SiteState("Samsun", SAMSUN, 1, "Europe/Istanbul", met_station=MetStation("mast"))


def stored(
    folder: Path, *changes: Callable[[dict[str, Any]], object], state: TrackerState = KEPT
) -> DatabaseWriter:
    url = Settings(data_dir=folder).url
    upgrade(url)
    writer = open_writer(url)
    begin(writer, NOW, unclean_since=None)
    writer.save_tracker(state)
    document = json.loads(TRACKER.write(state))
    for change in changes:
        change(document)
    rewrite(url, document=json.dumps(document))
    return writer


def rewrite(url: str, table: Table = tables.trackers, **columns: str | None) -> None:
    """Do what a person could do to the file with an editor."""
    engine = writing_engine(url)
    with transaction(engine) as connection:
        connection.execute(update(table).values(columns))
    engine.dispose()


def spoil(path: str, value: object) -> Callable[[dict[str, Any]], object]:
    *names, last = path.split(".")

    def change(document: dict[str, Any]) -> None:
        place = document
        for name in names:
            place = place[name]
        place[last] = value

    return change


@pytest.mark.fault(52)
def test_the_settings_accepted_last_are_used_where_stored_ones_do_not_fit(tmp_path: Path) -> None:
    ran = replace(KEPT, config=replace(KEPT.config, in_position_deg=0.2, park=Orientation(90.0, 45.0)))
    writer = stored(
        tmp_path,
        spoil("config.in_position_deg", "wide"),
        spoil("config.azimuth.minimum_deg", 999),
        spoil("config.deadband_deg", 0.9),
        spoil("memory.sightings", 5),
        state=ran,
    )
    with pytest.raises(StoreFailed):
        writer.trackers()
    (found,) = begin(writer, NOW, unclean_since=None).trackers
    assert found.config == ran.config, "a set that ran together, not a mixture"
    told = {one.what: (one.stored, one.used, one.is_last_accepted) for one in found.memory.rejected}
    assert told == {
        "in position deg": ("wide", "0.2", True),
        "azimuth minimum deg": ("999", "0.0", True),
        "deadband deg": ("0.9", "0.7", True),
        "memory sightings": ("5", "[]", False),
    }
    why = {one.what: one.why for one in found.memory.rejected}
    assert "valid number" in why["in position deg"]
    assert why["deadband deg"] == BESIDE
    assert found.memory.home is None
    assert not found.memory.tracking_on
    assert writer.trackers() == [found], "the next start finds what is used"
    assert begin(writer, NOW, unclean_since=None).trackers == (found,), "and it still waits for somebody"
    (entry, _) = (
        one for one in writer.journal(JournalFilter(limit=50)) if one.event.kind is EventKind.CONFIG_REJECTED
    )
    assert "in position deg: stored wide, used 0.2" in entry.event.message
    writer.close()


@pytest.mark.fault(52)
def test_values_that_do_not_fit_give_way_to_the_usual_where_no_others_are_known(tmp_path: Path) -> None:
    writer = stored(
        tmp_path,
        spoil("config.in_position_deg", "wide"),
        spoil("config.azimuth.minimum_deg", 999),
        spoil("config.strategy.kind", "guess"),
    )
    rewrite(Settings(data_dir=tmp_path).url, accepted="an older version's")
    (found,) = begin(writer, NOW, unclean_since=None).trackers
    assert found.config.deadband_deg == 0.7, "what fits stays"
    assert found.config.in_position_deg == 0.05
    assert found.config.azimuth.minimum_deg == 0.0
    assert {one.what for one in found.memory.rejected} == {
        "in position deg",
        "azimuth minimum deg",
        "strategy",
    }
    assert not any(one.is_last_accepted for one in found.memory.rejected)
    writer.close()


@pytest.mark.fault(52)
def test_only_the_tracker_whose_settings_do_not_fit_falls_back(tmp_path: Path) -> None:
    writer = stored(tmp_path, spoil("config.in_position_deg", "wide"))
    other = TrackerState(TrackerConfig("T2", "South", deadband_deg=0.3), KEPT.memory)
    writer.save_tracker(other)
    north, south = begin(writer, NOW, unclean_since=None).trackers
    assert north.memory.rejected
    assert south == other
    writer.close()


@pytest.mark.fault(52)
def test_settings_that_do_not_go_together_are_told_too(tmp_path: Path) -> None:
    odd = replace(KEPT, config=replace(KEPT.config, park=Orientation(180.0, 45.0), in_position_deg=0.9))
    writer = stored(tmp_path, state=odd)
    (found,) = begin(writer, NOW, unclean_since=None).trackers
    assert "must not exceed the deadband" in found.memory.rejected[0].why
    assert found.memory.home is not None, "the zero has nothing to do with it"
    writer.close()


@pytest.mark.fault(52)
def test_settings_that_do_not_go_together_give_way_to_those_accepted_last(tmp_path: Path) -> None:
    writer = stored(tmp_path, spoil("config.deadband_deg", 99.0))
    (found,) = begin(writer, NOW, unclean_since=None).trackers
    assert found.config == KEPT.config
    (told,) = found.memory.rejected
    assert (told.what, told.stored, told.used, told.is_last_accepted) == ("deadband deg", "99.0", "0.7", True)
    assert "Deadband must be between 0.02 and 10." in told.why
    writer.close()


@pytest.mark.parametrize("document", ["not json", "{}", "[]", '{"config": {}}'])
def test_what_is_no_tracker_gives_way_to_the_settings_accepted_last(tmp_path: Path, document: str) -> None:
    writer = stored(tmp_path)
    rewrite(Settings(data_dir=tmp_path).url, document=document)
    (found,) = begin(writer, NOW, unclean_since=None).trackers
    assert found.config == KEPT.config
    assert found.memory.home is None
    assert found.memory.rejected[0].what in ("all settings", "tracker id")
    rewrite(Settings(data_dir=tmp_path).url, document=document, accepted=None)
    with pytest.raises(StoreFailed, match="stored tracker"):
        begin(writer, NOW, unclean_since=None)
    writer.close()


async def rejected_plant(tmp_path: Path) -> Plant:
    writer = stored(tmp_path, spoil("config.in_position_deg", "wide"))
    beginning = begin(writer, NOW, unclean_since=None)
    writer.close()
    plant = make_plant(trackers=beginning.trackers)
    await plant.start()
    return plant


@pytest.mark.fault(52)
async def test_nothing_moves_until_the_settings_were_saved(tmp_path: Path, fault: FaultResult) -> None:
    plant = await rejected_plant(tmp_path)
    await plant.forward(seconds=1.0)
    for command in (Jog("p1", Axis.AZIMUTH, 1), Track()):
        with pytest.raises(CommandRejected, match=r"in position deg was wide, used is 0\.05") as refused:
            await plant.ask(command)
        fault.shows(str(refused.value))
    assert "config_rejected" in {reason.code for reason in plant.tracker().notices}
    await plant.ask(Stop())
    await plant.forward(seconds=1.0)
    await plant.ask(ConfigureTracker(plant.site.model.tracker("T1").config))
    assert plant.tracker().rejected == ()
    await plant.ask(Jog("p2", Axis.AZIMUTH, 1))
    fault.prevented("noticed at the start, before anything moves")
    fault.recovers("the engineer saves the settings again")
    await plant.close()


BAD_SITES: dict[str, tuple[Callable[[dict[str, Any]], object], str]] = {
    "a latitude of 95": (spoil("location.latitude_deg", 95.0), "location"),
    "a port of 0": (spoil("met_station", {"host": "mast", "port": 0, "unit": 1}), "met station"),
    "a clock of words": (spoil("clock.offset_s", "soon"), "clock offset s"),
    "a zone of numbers": (spoil("time_zone", 3), "time zone"),
    "windows that cannot be": (spoil("weather_windows", {"gust_s": -1}), "weather windows"),
}


@pytest.mark.fault(52)
@pytest.mark.parametrize(("change", "what"), BAD_SITES.values(), ids=BAD_SITES)
async def test_a_site_with_a_value_that_does_not_fit_starts_without_it_and_says_so(
    change: Callable[[dict[str, Any]], object], what: str, tmp_path: Path
) -> None:
    writer = stored(tmp_path)
    document = json.loads(SITE.write(SITE_KEPT))
    change(document)
    rewrite(Settings(data_dir=tmp_path).url, tables.site, document=json.dumps(document))
    found = begin(writer, NOW, unclean_since=None)
    assert found.site.name == "Samsun", "what fits stays"
    said = [one.event for one in writer.journal(JournalFilter()) if one.event.tracker_id is None]
    told = [one.message for one in said if one.kind is EventKind.CONFIG_REJECTED]
    assert len(told) == 1
    assert told[0].startswith(f"Stored settings of Samsun were rejected at startup: {what}: stored ")
    assert begin(writer, NOW, unclean_since=None).site == found.site
    plant = make_plant(state=found.site, trackers=found.trackers)
    await plant.start()
    await plant.forward(seconds=1)
    assert plant.site.alive
    await plant.close()
    writer.close()


@pytest.mark.parametrize("document", ["[]", "{"])
def test_a_site_that_nobody_can_read_stays_as_it_is_stored(document: str, tmp_path: Path) -> None:
    """The controller runs in safe mode then, and a backup can be restored: nothing is stored in its place."""
    writer, url = stored(tmp_path), Settings(data_dir=tmp_path).url
    rewrite(url, tables.site, document=document)
    with pytest.raises(StoreUnreadable, match="The stored site cannot be read"):
        begin(writer, NOW, unclean_since=None)
    engine = writing_engine(url)
    with transaction(engine) as connection:
        assert connection.execute(select(tables.site.c.document)).scalar_one() == document
    engine.dispose()
    writer.close()


def test_an_address_that_does_not_fit_is_told_without_its_secret(tmp_path: Path) -> None:
    writer = stored(tmp_path)
    document = json.loads(SITE.write(SITE_KEPT))
    document["notifications"]["webhook_url"] = "ftp://hooks.example/services/hush"
    rewrite(Settings(data_dir=tmp_path).url, tables.site, document=json.dumps(document))
    begin(writer, NOW, unclean_since=None)
    (told,) = (
        one.event for one in writer.journal(JournalFilter()) if one.event.kind is EventKind.CONFIG_REJECTED
    )
    assert "ftp://hooks.example/***" in told.message
    assert "hush" not in told.message + json.dumps(told.data)
    writer.close()


async def test_an_alarm_and_a_recording_that_nobody_can_read_keep_no_controller_from_starting(
    tmp_path: Path,
) -> None:
    writer = stored(tmp_path)
    writer.save_alarms(
        [
            KeptAlarm(
                Alarm("drive_lost", "T1", "North", "It is silent.", active=True, told=True, raised_at=NOW),
                None,
            )
        ]
    )
    writer.begin_recording(day_info("a day"))
    url = Settings(data_dir=tmp_path).url
    rewrite(url, tables.alarms, document="{}")
    rewrite(url, tables.recordings, document="[]")
    rewrite(url, tables.events, kind="unheard of", data="{")
    found = begin(writer, NOW, unclean_since=None)
    assert found.alarms == ()
    assert begin(writer, NOW, unclean_since=None).events[0].data["cut_off"] == []
    writer.close()
