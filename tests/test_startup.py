"""A quick start: the collector rests while modules are loaded, and works seldom afterwards."""

import gc

from app.base.startup import OF_A_TRACKER, RELAXED, SELDOM, hurry, settle


def test_the_collector_rests_until_everything_is_loaded_and_then_goes_by_the_trackers() -> None:
    found = gc.get_threshold()
    try:
        hurry()
        assert gc.get_threshold() == RELAXED
        settle(trackers=1000)
        assert gc.get_threshold() == (SELDOM[0] + 1000 * OF_A_TRACKER, *SELDOM[1:])
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()
        gc.set_threshold(*found)
