"""The question before a location that is likely to be mistaken, and what each of its answers saves."""

import re
from collections.abc import Mapping
from html import unescape

import httpx
import pytest

from app.sun.position import Location
from app.web.features.site.place import Doubt, place_doubts
from app.web.features.site.place_question import likeliest, question
from tests.fakes import FakeMachine
from tests.web.test_place import HTMX, PAGE, SAMSUN, SUMMER, form, saved

ASKED_FOR = re.compile(r'name="asked_for" value="([^"]*)"')
INSTEAD = re.compile(r'name="instead"\s+value="([^"]*)"')
DEVICE = "Europe/Istanbul"


async def ask(client: httpx.AsyncClient, typed: Mapping[str, str]) -> str:
    answer = await client.post(PAGE, data=dict(typed), headers=HTMX)
    assert answer.status_code == 422
    return unescape(answer.text)


@pytest.fixture
def stored(machine: FakeMachine) -> Location:
    machine.rest()
    assert machine.site.location is not None
    return machine.site.location


def mistakes(stored: Location) -> dict[str, dict[str, str]]:
    """Return what is typed by mistake, by the answer that saves what was meant."""
    there = {"device_zone": DEVICE}
    return {
        "E": form(stored.latitude_deg, stored.longitude_deg, longitude_side="W", **there),
        "N": form(stored.latitude_deg, stored.longitude_deg, latitude_side="S", **there),
        "swapped": form(stored.longitude_deg, stored.latitude_deg, **there),
    }


@pytest.mark.parametrize("answer", ["E", "N", "swapped"])
async def test_the_likelier_location_is_saved_in_one_press(
    client: httpx.AsyncClient, machine: FakeMachine, stored: Location, answer: str
) -> None:
    typed = mistakes(stored)[answer]
    asked = await ask(client, typed)
    assert INSTEAD.findall(asked) == [answer]
    assert "data-cancel" not in asked
    assert not saved(machine)
    sent = typed | {"asked_for": ASKED_FOR.findall(asked)[0], "instead": answer}
    assert (await client.post(PAGE, data=sent)).status_code == 303
    (order,) = saved(machine)
    assert order.location.latitude_deg == pytest.approx(stored.latitude_deg)
    assert order.location.longitude_deg == pytest.approx(stored.longitude_deg)


@pytest.mark.parametrize("answer", ["E", "N", "swapped"])
async def test_what_was_entered_is_saved_only_when_it_is_kept(
    client: httpx.AsyncClient, machine: FakeMachine, stored: Location, answer: str
) -> None:
    typed = mistakes(stored)[answer]
    asked_for = ASKED_FOR.findall(await ask(client, typed))[0]
    await ask(client, typed | {"asked_for": asked_for})
    assert not saved(machine)
    kept = typed | {"asked_for": asked_for, "sun_there": "yes"}
    assert (await client.post(PAGE, data=kept)).status_code == 303
    (order,) = saved(machine)
    assert order.location.latitude_deg != pytest.approx(stored.latitude_deg) or (
        order.location.longitude_deg != pytest.approx(stored.longitude_deg)
    )


async def test_an_answer_counts_for_no_other_location(
    client: httpx.AsyncClient, machine: FakeMachine, stored: Location
) -> None:
    typed = mistakes(stored)["E"]
    asked_for = ASKED_FOR.findall(await ask(client, typed))[0]
    moved = typed | {"latitude": "12.5", "asked_for": asked_for, "sun_there": "yes"}
    assert ASKED_FOR.findall(await ask(client, moved))[0] != asked_for
    assert not saved(machine)


async def test_the_other_location_is_asked_about_too_where_it_is_doubted(
    client: httpx.AsyncClient, machine: FakeMachine, stored: Location
) -> None:
    """At sea off Portugal and in Greece, both far from the stored location."""
    typed = form(40.0, 22.0, longitude_side="W")
    asked = await ask(client, typed)
    assert INSTEAD.findall(asked) == ["E"]
    asked = await ask(client, typed | {"instead": "E", "asked_for": ASKED_FOR.findall(asked)[0]})
    assert "The stored location is" in asked
    assert not INSTEAD.findall(asked)
    assert "data-cancel" in asked, "there is no safe answer but to go back"
    assert 'value="E" checked' in asked
    assert not saved(machine)


async def test_a_side_that_is_chosen_already_is_not_turned_again(
    client: httpx.AsyncClient, machine: FakeMachine, stored: Location
) -> None:
    """Without a script, the question stands while the side is changed by hand."""
    right = form(stored.latitude_deg, stored.longitude_deg, longitude_side="E", instead="E")
    assert (await client.post(PAGE, data=right)).status_code == 303
    assert saved(machine)[0].location.longitude_deg == pytest.approx(stored.longitude_deg)


async def test_without_a_script_the_whole_page_asks(client: httpx.AsyncClient, stored: Location) -> None:
    answer = await client.post(PAGE, data=mistakes(stored)["E"])
    assert answer.status_code == 422
    assert answer.text.startswith("<!doctype html>")
    assert "hx-partial" not in answer.text
    assert INSTEAD.findall(answer.text) == ["E"]


async def test_the_map_has_both_locations_as_long_as_it_is_asked(
    client: httpx.AsyncClient, stored: Location
) -> None:
    typed = mistakes(stored)["E"]
    asked_for = ASKED_FOR.findall(await ask(client, typed))[0]
    open_question = await client.get(f"{PAGE}/preview", params=typed | {"asked_for": asked_for}, headers=HTMX)
    assert open_question.text.count("map-doubted") == 2, "in the map and in the larger one"
    assert open_question.text.count("map-place") == 2
    moved = typed | {"asked_for": asked_for, "latitude": "12"}
    for params in (typed, moved):
        alone = await client.get(f"{PAGE}/preview", params=params, headers=HTMX)
        assert "map-doubted" not in alone.text
        assert alone.text.count("map-place") == 2


def test_what_the_likelier_location_mends_is_not_told_besides() -> None:
    def doubts_of(place: Location) -> tuple[Doubt, ...]:
        return place_doubts(place, DEVICE, SUMMER, before=SAMSUN)

    west = Location(41.2867, -36.33)
    doubts = doubts_of(west)
    assert len(doubts) == 3
    asked = question(west, DEVICE, doubts, doubts_of, is_compared=True)
    assert asked.sentences == (doubts[0].sentence,)
    assert (asked.instead_label, asked.keep_label, asked.doubted) == ("Use east", "Keep west", "longitude")


def test_of_many_doubts_each_is_told_before_the_location_is_kept() -> None:
    place = Location(0.0, -170.0)
    doubts = place_doubts(place, DEVICE, SUMMER, before=SAMSUN, device_zone=DEVICE)
    assert likeliest(doubts) is None
    assert len(doubts) > 2
    for is_compared in (True, False):
        asked = question(place, DEVICE, doubts, lambda _: (), is_compared=is_compared)
        assert asked.sentences == tuple(doubt.sentence for doubt in doubts)
        assert (asked.instead, asked.keep_label) == ("", "Keep this location")
