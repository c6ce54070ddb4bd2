"""A location that is likely to be mistaken: the page shows where its sun would be now, and asks."""

from dataclasses import replace
from datetime import UTC, datetime

import httpx
import pytest

from app.link.messages import SetLocation
from app.sun.position import Location
from app.tracker.memory.memory import CommissioningLock
from app.web.features.site.location import LocationForm
from app.web.features.site.place import Mistake, place_doubts
from tests.fakes import FakeMachine
from tests.fault_result import FaultResult

SUMMER = datetime(2027, 6, 21, 9, tzinfo=UTC)
SAMSUN = Location(41.2867, 36.33)
PAGE = "/trackers/T1/commissioning/location"
HTMX = {"HX-Request": "true"}


def saved(machine: FakeMachine) -> list[SetLocation]:
    return [order.command for order in machine.orders if isinstance(order.command, SetLocation)]


def said_of(place: Location, time_zone: str, before: Location | None = None, device: str = "") -> list[str]:
    doubts = place_doubts(place, time_zone, SUMMER, before=before, device_zone=device)
    return [doubt.sentence for doubt in doubts]


def form(latitude_deg: float, longitude_deg: float, **others: str) -> dict[str, str]:
    typed = {"latitude": f"{latitude_deg:.7g}", "longitude": f"{longitude_deg:.7g}", **others}
    return LocationForm().model_dump(exclude={"sun_there"}) | typed


@pytest.mark.parametrize(
    ("place", "time_zone", "said"),
    [
        (SAMSUN, "Europe/Istanbul", ""),
        (Location(36.33, 41.2867), "Europe/Istanbul", "in the time zone Europe/Istanbul"),
        (
            Location(41.2867, -36.33),
            "Europe/Istanbul",
            "Solar noon there is at 17:25 in the time zone Europe/Istanbul",
        ),
        (Location(-33.92, 18.42), "Africa/Johannesburg", ""),
        (Location(1.87, -157.4), "Pacific/Kiritimati", ""),
        (Location(0.0, 170.0), "Etc/GMT-11", "is in the sea"),
        (Location(41.2867, -36.33), "Etc/GMT+2", "with east and west swapped, it is on land"),
        (Location(-41.2867, 36.33), "Etc/GMT-2", "is in the sea"),
        (Location(-37.0, 144.9), "Australia/Melbourne", ""),
    ],
)
def test_what_speaks_against_a_place(place: Location, time_zone: str, said: str) -> None:
    sentences = said_of(place, time_zone)
    assert (said in " ".join(sentences)) if said else sentences == []


def test_numbers_of_the_stored_place_exchanged_and_a_device_far_away() -> None:
    exchanged = Location(36.33, 41.2867)
    assert "stored location" in said_of(exchanged, "UTC", SAMSUN)[0]
    assert said_of(SAMSUN, "UTC", exchanged)[0].startswith("These are the coordinates of the stored location")
    (sign, far) = said_of(Location(41.2867, -36.33), "Etc/GMT+2", SAMSUN)
    assert sign == "These are the coordinates of the stored location with east and west swapped."
    assert far == "The stored location is 5880 km away."
    south = said_of(Location(-41.2867, 36.33), "Etc/GMT-2", SAMSUN)
    assert south[0] == "These are the coordinates of the stored location with north and south swapped."
    west = said_of(Location(52.0, -7.9), "Europe/Dublin", device="Europe/Amsterdam")
    assert west[0].startswith("With east and west swapped, the location is in the time zone of this device")
    assert said_of(SAMSUN, "UTC", Location(41.3, 36.4)) == []
    (far,) = said_of(SAMSUN, "Europe/Istanbul", device="America/New_York")
    assert "are you at the tracker" in far


def test_the_zone_of_the_device_counts_for_more_than_that_another_location_is_on_land() -> None:
    doubts = place_doubts(Location(47.0, -19.0), "Etc/GMT+1", SUMMER, device_zone="Europe/Budapest")
    assert [doubt.mistake for doubt in doubts[:2]] == [Mistake.EAST_WEST, Mistake.SWAPPED]


@pytest.mark.parametrize(
    ("place", "before", "mistake", "other"),
    [
        (Location(41.2867, -36.33), None, Mistake.EAST_WEST, SAMSUN),
        (Location(41.2867, -36.33), SAMSUN, Mistake.EAST_WEST, SAMSUN),
        (Location(-41.2867, 36.33), SAMSUN, Mistake.NORTH_SOUTH, SAMSUN),
        (Location(36.33, 41.2867), SAMSUN, Mistake.SWAPPED, SAMSUN),
        (Location(0.0, 170.0), None, None, None),
        (Location(52.0, 5.0), SAMSUN, None, None),
    ],
)
def test_a_doubt_knows_the_mistake_and_what_was_meant(
    place: Location, before: Location | None, mistake: Mistake | None, other: Location | None
) -> None:
    first = place_doubts(place, "UTC", SUMMER, before=before)[0]
    assert (first.mistake, first.other) == (mistake, other)


@pytest.mark.fault(37)
async def test_exchanged_numbers_are_asked_about_with_the_sun_there_now(
    machine: FakeMachine, client: httpx.AsyncClient, fault: FaultResult
) -> None:
    machine.rest()
    place = machine.site.location
    assert place is not None
    typed = form(place.longitude_deg, place.latitude_deg, device_zone=machine.site.time_zone)
    answer = await client.post(PAGE, data=typed, headers=HTMX)
    assert answer.status_code == 422
    assert not saved(machine)
    assert "latitude and longitude swapped" in answer.text
    assert answer.text.count('<th scope="row"') == 2, "the sun now at both locations"
    assert f'value="{place.longitude_deg}"' in answer.text, "what was typed stays"
    fault.prevented("refused when saved")
    fault.shows("These are the coordinates of the stored location with latitude and longitude swapped.")
    fault.recovers("with the right numbers, or when they are confirmed")

    answer = await client.post(PAGE, data=typed | {"sun_there": "yes"})
    assert answer.status_code == 303
    assert len(saved(machine)) == 1


@pytest.mark.fault(37)
async def test_a_program_confirms_what_speaks_against_its_place(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    place = {"latitude_deg": 41.2867, "longitude_deg": -36.33, "time_zone": "Europe/Istanbul"}
    refused = await client.put("/api/v1/site/location", json=place)
    assert refused.status_code == 422
    assert "17:25" in refused.text or "16:25" in refused.text
    assert "confirmed" in refused.text
    assert not saved(machine)
    assert (await client.put("/api/v1/site/location", json=place | {"confirmed": True})).status_code == 200
    assert len(saved(machine)) == 1


async def test_a_place_that_is_stored_is_not_asked_about_again(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    machine.rest()
    place = machine.site.location
    assert place is not None
    zones = {"time_zone": machine.site.time_zone, "device_zone": "Pacific/Auckland"}
    moved = form(place.latitude_deg + 0.01, place.longitude_deg, **zones)
    assert (await client.post(PAGE, data=moved, headers=HTMX)).status_code == 422
    assert not saved(machine)
    same = form(place.latitude_deg, place.longitude_deg, **zones)
    assert (await client.post(PAGE, data=same)).status_code == 303
    assert len(saved(machine)) == 1


async def test_a_location_that_cannot_be_saved_is_refused_before_it_is_asked_about(
    machine: FakeMachine, client: httpx.AsyncClient
) -> None:
    place = machine.site.location
    assert place is not None
    typed = form(place.longitude_deg, place.latitude_deg)
    answer = await client.post(PAGE, data=typed, headers=HTMX)
    assert answer.status_code == 409
    assert "T2 is tracking the sun for the present location." in answer.text
    assert "End tracking of T2 first." in answer.text
    assert "data-question" not in answer.text

    machine.rest()
    assert "data-question" in (await client.post(PAGE, data=typed, headers=HTMX)).text

    kept = machine.trackers["T1"]
    kept.memory = replace(kept.memory, settings_lock=CommissioningLock("ada", SUMMER))
    answer = await client.post(PAGE, data=typed, headers=HTMX)
    assert answer.status_code == 409
    assert "The settings of North field were locked by ada" in answer.text
    stored = form(place.latitude_deg, place.longitude_deg, altitude=str(place.altitude_m))
    zone = stored | {"time_zone": "Pacific/Auckland"}
    assert "data-question" in (await client.post(PAGE, data=zone, headers=HTMX)).text, "only the zone differs"
    assert not saved(machine)
