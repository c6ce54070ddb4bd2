"""Stored data with which the controller cannot start: safe mode, in which every drive can be stopped."""

from pathlib import Path

import pytest
from sqlalchemy import update

from app.link.messages import StopAll
from app.store import tables
from app.store.connections import transaction, writing_engine
from app.tracker.commands.commands import CommandRejected, Park
from tests.fault_result import FaultResult
from tests.machine.field import prepare
from tests.machine.lives import Machine
from tests.machine.service import SAMSUN
from tests.patience import eventually

UNFIT = {"no tracker": "[]", "no JSON": "{"}


def spoil(url: str, document: str) -> None:
    """Do what a person could do to the file with an editor."""
    engine = writing_engine(url)
    with transaction(engine) as connection:
        connection.execute(update(tables.trackers).values(document=document, accepted=None))
    engine.dispose()


@pytest.mark.fault(105)
@pytest.mark.parametrize("document", UNFIT.values(), ids=UNFIT)
async def test_a_tracker_that_nobody_can_read_leads_to_safe_mode(
    document: str, tmp_path: Path, fault: FaultResult
) -> None:
    machine = Machine.of(tmp_path / "data")
    prepare(machine.data_dir, 1, SAMSUN)
    spoil(machine.settings.url, document)
    await machine.start()
    await eventually(lambda: "store_damaged" in machine.alarms())
    with pytest.raises(CommandRejected, match=r"in safe mode.*cannot start with what is stored") as refused:
        await machine.ask(Park())
    await machine.ask(StopAll())
    await machine.stop()
    fault.prevented("safe mode from the start")
    fault.shows(str(refused.value))
    fault.recovers("a backup is restored")
