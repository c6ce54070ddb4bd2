"""Coordinates as maps, phones, receivers, and people write them: read right, or refused with a sentence."""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from html import unescape
from unicodedata import decimal

import httpx
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from app.link.messages import SetLocation
from app.sun.position import Location
from app.web.features.site.location import LocationForm, read
from app.web.features.site.place_preview import normal_form
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.shell import coordinates
from app.web.shell.coordinates import Refusal, Refused
from app.web.shell.forms import Unreadable
from app.web.shell.map_links import is_link
from tests.amount import amount
from tests.fakes import FakeMachine
from tests.fault_result import FaultResult
from tests.golden.table import rows
from tests.web.filled import filled

PAGE = "/trackers/T1/commissioning/location"
HTMX = {"HX-Request": "true"}
ERROR = re.compile(r'-error">([^<]*)')
NEAR_DEG = 1e-6
OTHER = {"latitude": "41.2867", "longitude": "36.33"}
SENTENCES = {
    Refusal.FORM: "type degrees such as 41.2867, or degrees, minutes, and seconds",
    Refusal.FRACTION: "only the last number may have decimals",
    Refusal.SIXTY: "minutes and seconds must be below 60.",
    Refusal.LETTER: "the letter must be",
    Refusal.SIGN: "leave out the plus or minus sign",
    Refusal.RANGE: "must be between 0 and",
    Refusal.PAIR: "enter one coordinate per field, or both with a semicolon, latitude first",
    Refusal.CODE: "this link or code has no latitude and longitude that can be read.",
}


ROWS = rows("world/coordinates.csv")
LANGUAGES = sorted({row["language"] for row in ROWS})


@contextmanager
def speaking(language: str) -> Iterator[None]:
    before = CATALOGUE.set(catalogue_of(language))
    try:
        yield
    finally:
        CATALOGUE.reset(before)


def right_place(row: dict[str, str]) -> Location:
    """Return the place of a row; what it does not name is in the other field."""
    return Location(*(float(row[name] or OTHER[name]) for name in OTHER))


def is_at(found: Location, right: Location) -> bool:
    return (
        abs(found.latitude_deg - right.latitude_deg) < NEAR_DEG
        and abs(found.longitude_deg - right.longitude_deg) < NEAR_DEG
    )


async def wrong(
    client: httpx.AsyncClient, machine: FakeMachine, row: dict[str, str], form: dict[str, str | list[str]]
) -> str:
    """Return what is wrong with preview and saving of a row, nothing if both are right."""
    machine.orders.clear()
    headers = {**HTMX, "Accept-Language": row["language"].replace("_", "-")}
    typed = OTHER | {row["field"]: row["text"], "sun_there": "yes"}
    shown = unescape((await client.get(f"{PAGE}/preview", params=typed, headers=headers)).text)
    answer = await client.post(PAGE, data=form | typed, headers=headers)
    orders = [order.command for order in machine.orders if isinstance(order.command, SetLocation)]
    if row["refusal"]:
        sentence = SENTENCES[Refusal(row["refusal"])] if row["language"] == "en" else ""
        if orders or answer.status_code != 422:
            return f"saved as {orders}"
        if answer.text.count('aria-invalid="true"') != 1 or sentence not in unescape(answer.text):
            return "refused with another sentence"
        return "" if sentence in shown or not row["text"] else "refused without a word before it is saved"
    if len(orders) != 1:
        return f"refused: {ERROR.findall(unescape(answer.text))}"
    saved = orders[0].location
    with speaking(row["language"]):
        is_shown = normal_form(saved) in shown
    return "" if is_at(saved, right_place(row)) and is_shown else f"saved as {saved}, shown: {is_shown}"


def misread(row: dict[str, str]) -> str:
    """Return what is wrong with how a row is read, nothing if it is right."""
    with speaking(row["language"]):
        found = read(LocationForm(**(OTHER | {row["field"]: row["text"]})))
    if row["refusal"]:
        sentence = SENTENCES[Refusal(row["refusal"])] if row["language"] == "en" else ""
        told = " ".join(map(str, found.typed.errors.values()))
        return "" if told and sentence in told else f"refused with {told!r}"
    return "" if found.location and is_at(found.location, right_place(row)) else f"read as {found.location}"


def test_every_form_is_read_right_or_refused() -> None:
    assert {row["refusal"] for row in ROWS} == {*Refusal, ""}, "the table has every refusal"
    found = {(row["field"], row["text"]): words for row in ROWS if (words := misread(row))}
    assert found == {}


@pytest.mark.fault(104)
@pytest.mark.parametrize("language", LANGUAGES)
async def test_every_form_is_shown_and_saved_right_or_refused(
    client: httpx.AsyncClient, machine: FakeMachine, language: str, fault: FaultResult
) -> None:
    form = await filled(client, PAGE)
    found = {
        (row["field"], row["text"]): words
        for row in [row for row in ROWS if row["language"] == language][:: amount(5, 1)]
        if (words := await wrong(client, machine, row, form))
    }
    assert found == {}
    with pytest.raises(Unreadable) as refused:
        coordinates.angle("41.2867 36", "latitude")
    fault.prevented("refused unless there is one reading only")
    fault.shows(str(refused.value))
    fault.recovers("the coordinates are typed so that they mean one place")


async def test_a_pair_fills_both_fields_and_presses_both_sides(client: httpx.AsyncClient) -> None:
    texts = read(LocationForm(latitude="33°55'29.64\"S 70°30'W", longitude="36.33")).typed.texts
    assert (texts["latitude"], texts["latitude_side"]) == ("33.9249", "S")
    assert (texts["longitude"], texts["longitude_side"]) == ("70.5", "W")
    shown = await client.get(f"{PAGE}/preview", params={"longitude": "41,2867; -36,33"}, headers=HTMX)
    assert 'data-latitude="41.2867" data-longitude="36.33"' in shown.text
    assert 'data-longitude-side="W"' in shown.text
    alone = await client.get(f"{PAGE}/preview", params=OTHER, headers=HTMX)
    assert "data-latitude=" not in alone.text


def test_two_pairs_that_differ_are_refused() -> None:
    pair = "41.2867; 36.33"
    assert read(LocationForm(latitude=pair, longitude="(41.2867, 36.33)")).location == Location(
        41.2867, 36.33
    )
    errors = read(LocationForm(latitude=pair, longitude="42; 37")).typed.errors
    assert all(SENTENCES[Refusal.PAIR] in str(errors[name]) for name in OTHER)


def test_a_sign_or_the_pressed_button_gives_the_side_and_both_are_refused() -> None:
    for text, chosen in (("-33.9", "N"), ("33.9", "S")):
        assert coordinates.angle(text, "latitude", chosen) == -33.9
    for text in ("-33.9", "+33.9"):
        with pytest.raises(Unreadable, match=SENTENCES[Refusal.SIGN]):
            coordinates.angle(text, "latitude", "S")


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        ({"longitude": "1 30"}, 'value="1 30"'),
        ({"latitude": "-33.9 S"}, SENTENCES[Refusal.SIGN]),
        ({"latitude": "41.2867, 200"}, "Longitude must be between 0 and 180"),
    ],
)
async def test_the_studies_read_coordinates_by_the_same_rules(
    client: httpx.AsyncClient, typed: dict[str, str], said: str
) -> None:
    sent = {"date": "2026-06-21", "modes": "dual", "strategies": "deadband", **OTHER, **typed, "range": "999"}
    answer = await client.post("/studies", data=await filled(client, "/studies", sent), headers=HTMX)
    assert answer.status_code == 422
    assert said in unescape(answer.text)
    question = {"date": "2026-06-21", **OTHER, **typed, "range": "999"}
    program = await client.get("/studies/program", params=question, headers=HTMX)
    assert program.status_code == 422
    assert said in unescape(program.text)


PARTS = ("0", "1", "7", "17", "36", "41", "59", "60", "90", "180", "12.5", "36,33", "41.2867", "٤", "４")
GLUE = (
    "", "", " ", " ", "°", "° ", "'", "' ", '"', "''", "d", "m", "s", " deg ", ":", ";", ", ", ",", "-", " -",
    "−", "+", "N", " N ", "S", " S", "E", " E", "W", "n", "O", "D", "K", "Lat ", " Lon: ", " / ", "(", ")",
    "\u00a0", "\u2033", "º", "ſ", "\u212a", "geo:", "\t", ".",
)  # fmt: skip
PIECES = st.tuples(st.sampled_from(GLUE), st.sampled_from(PARTS), st.sampled_from(GLUE)).map("".join)
SOUP = st.lists(PIECES, max_size=6).map("".join)
BEFORE = st.sampled_from(("", "", "", "-", "−", "+", "N", "S ", "E ", "W", "Lat: ", "Lon "))
MARKS = st.sampled_from((" ", "°", "° ", "' ", "d", "m", ":", "-"))
AFTER = st.sampled_from(("", "", "", "°", "'", '"', "s", "N", " S", " E", "W"))
NUMBER = st.sampled_from(PARTS)
ANGLES = st.tuples(
    BEFORE, NUMBER, st.lists(st.tuples(MARKS, NUMBER).map("".join), max_size=2).map("".join), AFTER
)
PAIRS = st.tuples(ANGLES.map("".join), st.sampled_from((" ", ", ", "; ", ",")), ANGLES.map("".join)).map(
    "".join
)
TEXTS = SOUP | st.text(max_size=40) | ANGLES.map("".join) | PAIRS
NUMBERS = re.compile(r"\d+(?:[.,]\d+)?")


def strictly(numbers: list[str]) -> float | None:
    """Return degrees, minutes, and seconds as one number, None where they are no angle."""
    *whole, last = (number.replace(",", ".") for number in numbers)
    values = [*map(float, (*whole, last)), 0.0, 0.0]
    is_angle = not any("." in number for number in whole) and values[1] < 60 and values[2] < 60
    return values[0] + values[1] / 60 + values[2] / 3600 if is_angle else None


def strict_readings(text: str) -> set[tuple[float, ...]]:
    """Return every way to divide the numbers of a text into one angle or two, without their sides."""
    numbers = NUMBERS.findall(text)
    spans = [(numbers,)] if 1 <= len(numbers) <= 3 else []
    pairs = [(numbers[:at], numbers[at:]) for at in (1, 2, 3) if 1 <= len(numbers) - at <= 3]
    if "." in text:  # then a comma is not a decimal sign
        numbers = re.findall(r"\d+(?:\.\d+)?", text)
        pairs += [(numbers[:at], numbers[at:]) for at in (1, 2, 3) if 1 <= len(numbers) - at <= 3]
    found = {tuple(strictly(part) for part in parts) for parts in (*spans, *pairs)}
    return {tuple(round(one, 9) for one in each if one is not None) for each in found if None not in each}


@given(TEXTS, st.sampled_from(LANGUAGES), st.sampled_from(list(OTHER)))
@example("41\u212a", "en", "latitude")
@example("41 1\u017f", "en", "latitude")
@example("http://[", "en", "latitude")
@example("41" * 2000, "en", "longitude")
def test_any_text_is_a_coordinate_or_is_refused_with_a_sentence(text: str, language: str, axis: str) -> None:
    with speaking(language):
        typed = read(LocationForm(**(OTHER | {axis: text}))).typed
        found = coordinates.read(typed, axis)
    assert abs(found) <= coordinates.LIMITS_DEG[axis] or str(typed.errors[axis]).endswith(".")


@given(TEXTS, st.sampled_from(LANGUAGES))
def test_what_is_read_is_what_the_numbers_of_the_text_say(text: str, language: str) -> None:
    plain = "".join(str(decimal(letter, letter)) for letter in text)
    assume(not is_link(text.strip()) and not re.search(r"\d{4}", plain.partition(".")[0]))
    with speaking(language):
        try:
            found = coordinates.angles(text)
        except Refused:
            return
    values = tuple(round(one.degrees, 9) for one in found)
    assert {values, values[::-1]} & strict_readings(plain)
    assert all(one.sign != "-" for one in found) or set(text) & {*coordinates.SIGNS["-"], "-"}


@given(st.floats(-90, 90), st.floats(-180, 180), st.sampled_from(LANGUAGES))
@example(-89.9999999, 179.9999999, "en")
@example(-0.0, -180.0, "en")
def test_a_place_as_the_page_shows_it_is_read_back(latitude: float, longitude: float, language: str) -> None:
    with speaking(language):
        found = read(LocationForm(latitude=normal_form(Location(latitude, longitude)))).location
    assert found is not None
    assert abs(found.latitude_deg - latitude) < 0.051 / 3600
    assert abs(found.longitude_deg - longitude) < 0.051 / 3600
