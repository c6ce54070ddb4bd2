"""Every page, as it is now, was looked at in a browser; none is left out. This test opens none itself."""

import pytest

from tests.browser.every_page import unvisited
from tests.looks.rendered import everything
from tests.looks.stamp import due, kept, sums

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


async def test_every_page_was_looked_at_as_it_is_now() -> None:
    left = due(sums(await everything()), kept())
    told = ", ".join(f"{name} ({' '.join(codes)})" for name, codes in left.items())
    assert not left, f"Run make looks. Not looked at as they are now: {told}"


def test_no_page_is_left_out() -> None:
    assert unvisited() == []
