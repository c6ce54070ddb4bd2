"""Every page, as it is now, was looked at in a browser; none is left out. This test opens none itself."""

import pytest

from tests.browser.every_page import NO_PAGES, STUDY_ID, unvisited
from tests.fakes import fake_app, serving
from tests.looks.rendered import everything
from tests.looks.stamp import due, kept, sums
from tests.web.route_table import ROUTES

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")


async def test_every_page_was_looked_at_as_it_is_now() -> None:
    left = due(sums(await everything()), kept())
    told = ", ".join(f"{name} ({' '.join(codes)})" for name, codes in left.items())
    assert not left, f"Run make looks. Not looked at as they are now: {told}"


def test_no_page_is_left_out() -> None:
    assert unvisited() == []


async def test_what_is_said_to_be_no_page_is_a_route_and_answers_with_none() -> None:
    assert [route for route in NO_PAGES if f"GET {route}" not in ROUTES] == []
    given = {"{study_id}": STUDY_ID, "{tracker_id}": "T1", "{step}": "location", "{name}": "homing-1024.png"}
    asked = [route for route, what in NO_PAGES.items() if what != "a file" and "{number}" not in route]
    async with serving(fake_app()) as client:
        for route in asked:
            for name, value in given.items():
                route = route.replace(name, value)
            answer = await client.get(route, headers={"hx-request": "true"})
            assert answer.status_code in (200, 303), route
            assert not answer.text.lstrip().lower().startswith("<!doctype html"), route
