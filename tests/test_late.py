"""A quick start: the collector rests while modules are loaded, and works seldom afterwards."""

import gc

from app.base.startup import OF_A_TRACKER, RELAXED, SELDOM, hurry, late, settle


def test_the_collector_rests_until_everything_is_loaded() -> None:
    found = gc.get_threshold()
    try:
        hurry()
        assert gc.get_threshold() == RELAXED
        settle()
        assert gc.get_threshold() == SELDOM
        assert gc.get_freeze_count() > 0
        settle(trackers=1000)
        assert gc.get_threshold() == (SELDOM[0] + 1000 * OF_A_TRACKER, *SELDOM[1:])
    finally:
        gc.unfreeze()
        gc.set_threshold(*found)


def test_a_late_module_is_the_same_one_every_time() -> None:
    assert late("colorsys") is late("colorsys")
