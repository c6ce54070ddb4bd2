"""Each library of an installation without extras is there for a reason that is told."""

from bench.installed import OWN, PURPOSES, installation


def test_every_library_that_is_asked_for_says_what_it_is_for() -> None:
    asked_for = {one.name for one in installation().values() if OWN in one.needed_by}
    assert asked_for | {OWN} == PURPOSES.keys()
