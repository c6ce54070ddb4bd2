"""A field at sunrise, without one of its lines, with its panel killed in a storm, and at its start.

A cut of each is in `make test`; the whole, with the ticks that a 99.9th percentile takes, in `make soak`.
"""

from pathlib import Path

import pytest

from app.tracker.settings.config import DriveKind
from tests.amount import amount
from tests.fault_result import BY_ITSELF, REAL, FaultResult
from tests.soak.rigs.fieldwork import (
    Size,
    gateway,
    loss_of_a_line,
    serial_line,
    start,
    sunrise,
    web_restart,
)

FIELD = Size(amount(12, 100), 100, amount(240, 12_000))
LARGEST = Size(amount(40, 1000), 1000, amount(80, 12_000))
AT_ONCE_S, LOST_WITHIN_S, BACK_WITHIN_S, READY_WITHIN_S = 1.0, 2.0, 5.0, 20.0
SUNRISE_IN_S = amount(3.0, 15.0)
VIEWERS = 20


@pytest.mark.fault(76)
async def test_a_field_wakes_at_sunrise_all_at_once(fault: FaultResult) -> None:
    trial = await sunrise(FIELD, ahead_s=SUNRISE_IN_S)
    trial.assert_punctual()
    assert trial.took_s <= AT_ONCE_S
    assert "begins to follow the sun. Motion starts in 5 s." in trial.shown
    fault.noticed(trial.took_s, REAL)
    fault.shows(trial.shown)
    fault.recovers(BY_ITSELF)


@pytest.mark.fault(77)
@pytest.mark.parametrize("kind", [DriveKind.MODBUS_TCP, DriveKind.MODBUS_RTU_OVER_TCP])
async def test_a_line_that_falls_silent_is_told_by_all_of_its_trackers_which_come_back(
    tmp_path: Path, kind: DriveKind, fault: FaultResult
) -> None:
    trial = await loss_of_a_line(FIELD, gateway(amount(10, 64), tmp_path, kind))
    trial.assert_punctual()
    assert trial.took_s <= LOST_WITHIN_S
    assert trial.back_s <= BACK_WITHIN_S
    assert "no longer answers" in trial.shown
    fault.noticed(trial.took_s, REAL)
    fault.shows(trial.shown)
    fault.recovers("automatic; the operator starts tracking again", trial.back_s)


async def test_a_serial_line_carries_as_many_drives_as_it_takes(tmp_path: Path) -> None:
    trial = await loss_of_a_line(FIELD, serial_line(amount(4, 14), tmp_path, 115_200))
    trial.assert_punctual()
    assert trial.took_s <= LOST_WITHIN_S
    assert trial.back_s <= BACK_WITHIN_S


@pytest.mark.fault(78)
async def test_a_panel_that_is_killed_in_a_storm_has_all_its_viewers_again(fault: FaultResult) -> None:
    trial = await web_restart(FIELD, viewers=VIEWERS)
    trial.assert_punctual()
    assert trial.took_s <= AT_ONCE_S
    fault.noticed(trial.took_s, REAL)
    fault.shows_nothing("every tracker stows, and every page says so again")
    fault.recovers(BY_ITSELF, trial.back_s)


@pytest.mark.fault(79)
async def test_a_large_field_starts(fault: FaultResult) -> None:
    trial, ready_s = await start(LARGEST)
    trial.assert_punctual()
    assert ready_s <= READY_WITHIN_S
    fault.noticed(ready_s, REAL)
    fault.shows_nothing("all trackers are there and track")
    fault.recovers(BY_ITSELF)
