"""Each library of an installation without extras is there for a reason that is told."""

import pytest

from bench.installed import EXTRAS, OWN, PURPOSES, installation
from tests.amount import amount

STUDIES = {"pandas", "pvlib", "scipy"}


def test_every_library_that_is_asked_for_says_what_it_is_for() -> None:
    asked_for = {one.name for one in installation().values() if OWN in one.needed_by}
    assert asked_for | {OWN} == PURPOSES.keys()


def test_what_a_library_brings_says_for_whom() -> None:
    base = installation()
    assert base["starlette"].purpose == "needed by fastapi"
    assert not base.keys() & STUDIES
    assert installation("studies").keys() >= STUDIES


@pytest.mark.parametrize("extra", EXTRAS[:: amount(3, 1)])
def test_an_extra_adds_to_the_base(extra: str) -> None:
    base, more = installation(), installation(extra)
    assert base.keys() < more.keys()
