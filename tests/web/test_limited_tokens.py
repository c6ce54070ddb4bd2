"""A token for one tracker sees and changes that one and no other, wherever it asks; and it stops them all."""

import re

import httpx
import pytest

from app.access.tokens import Scope
from app.base.permission import Permission
from app.tracker.commands.commands import Stop
from tests.fake_alarms import alarm
from tests.web.asgi import streaming
from tests.web.office import Office
from tests.web.route_table import ROUTES
from tests.web.sockets import connected

OTHER = re.compile(r"\bT1\b|North field")
IDS = {"tracker_id": "T2", "document": "operators", "name": "overview", "step": "location"}
READ = sorted(key for key, needs in ROUTES.items() if needs is Permission.READ and key.startswith("GET "))
LEFT_OUT = {"/api/v1/stream", "/api/v1/papers", "/api/v1/sun/accuracy", "/api/v1/studies/comparison"}
"""What never ends, and what takes seconds and is worked out without any tracker."""
EXAMPLES = ("/guide", "/search", "/api/v1/openapi.json", "/accuracy", "/papers")
TELLS_OF_ALL = ("/api/v1/trackers", "/api/v1/recordings", "/", "/journal")
QUERY = {"/api/v1/telemetry": "?tracker_id=T2&begin=2026-06-21T00:00:00Z&end=2026-06-22T00:00:00Z"}


async def bearer(office: Office, *scopes: Scope) -> dict[str, str]:
    return await office.bearer(*scopes, trackers=frozenset({"T2"}))


def addresses(office: Office) -> list[str]:
    """Return every address that is read, what belongs to T1 in the place of ids."""
    store = office.machine.store
    recording = next(one for one in store.heads.values() if one.tracker_id == "T1")
    ids = IDS | {"recording_id": recording.recording_id, "number": "1", "show_id": "s1", "study_id": "none"}
    filled = [re.sub(r"\{(\w+)\}", lambda part: ids[part[1]], key.removeprefix("GET ")) for key in READ]
    return [path + QUERY.get(path, "") for path in filled if path not in LEFT_OUT]


async def test_nothing_that_is_read_tells_of_another_tracker(office: Office) -> None:
    headers, whole, read = await bearer(office, Scope.READ), await office.bearer(Scope.READ), 0
    async with office.browser() as browser:
        for address in addresses(office):
            found = await browser.get(address, headers=headers)
            assert found.status_code < 500, address
            assert not OTHER.search(words(found)), f"{address} tells of T1: {words(found)[:2000]}"
            read += found.status_code == 200
        for address in TELLS_OF_ALL:
            assert OTHER.search(words(await browser.get(address, headers=whole))), "what T1 has is noticed"
    assert read > 60


def words(answer: httpx.Response) -> str:
    """Return what an answer says of this site; T1 as an example is no word of it."""
    is_example = answer.request.url.path.startswith(EXAMPLES)
    return "" if is_example else answer.text.replace('value="T1"', "")


async def test_the_most_urgent_of_another_tracker_is_not_told(office: Office) -> None:
    headers = await bearer(office, Scope.READ)
    office.machine.alarms = tuple(alarm("not_stowed", office.clock.now(), name) for name in ("T1", "T2"))
    office.machine.emit()
    async with office.browser() as browser:
        page = words(await browser.get("/", headers=headers))
    assert "T2 South field: Not stowed" in page
    assert not OTHER.search(page)


@pytest.mark.parametrize("path", ["/api/v1/trackers/T1/stop", "/api/v1/trackers/T2/stop", "/api/v1/stop"])
async def test_it_stops_every_tracker(office: Office, path: str) -> None:
    headers = await bearer(office, Scope.STOP)
    async with office.browser() as browser:
        assert (await browser.post(path, headers=headers)).status_code == 202
    assert len(office.machine.orders) == 1


async def test_it_stops_every_tracker_by_the_live_socket_and_is_shown_its_own(office: Office) -> None:
    headers = await bearer(office, Scope.READ, Scope.STOP)
    async with connected(office.app, headers=headers) as page:
        state = await page.next("state")
        assert [one["tracker_id"] for one in state["snapshot"]["trackers"]] == ["T2"]
        await page.send(type="stop", tracker_id="T1")
        assert (await page.next("stopped"))["tracker_id"] == "T1"
    assert [(order.command, order.tracker_id) for order in office.machine.orders] == [(Stop(), "T1")]


async def test_the_stream_tells_of_its_own_tracker(office: Office) -> None:
    headers = await bearer(office, Scope.READ)
    async with streaming(office.app, headers=headers) as reading:
        assert not OTHER.search(str(await reading.next("snapshot")))


CHANGES = [
    ("POST", "/api/v1/trackers/T1/commands", {"type": "track"}),
    ("POST", "/api/v1/control", {"tracker_ids": ["T1"]}),
    ("POST", "/api/v1/simulations", {"tracker_id": "T1", "date": "2026-06-21"}),
    ("POST", "/api/v1/recordings/{recording_id}/rerun", {}),
    ("PATCH", "/api/v1/trackers/T1", {"name": "Mine"}),
    ("DELETE", "/api/v1/recordings/{recording_id}", None),
    ("PATCH", "/api/v1/site", {"name": "Mine"}),
]


@pytest.mark.parametrize(("method", "path", "body"), CHANGES)
async def test_nothing_of_another_tracker_is_changed(
    office: Office, method: str, path: str, body: dict[str, object] | None
) -> None:
    headers = await bearer(office, Scope.MOTION, Scope.CONFIG)
    recording = next(one for one in office.machine.store.heads.values() if one.tracker_id == "T1")
    async with office.browser() as browser:
        address = path.format(recording_id=recording.recording_id)
        answer = await browser.request(method, address, json=body, headers=headers)
    assert answer.status_code in (403, 404), answer.text
    assert office.machine.orders == []


async def test_a_token_that_may_only_stop_is_told_what_it_may(office: Office) -> None:
    headers = await bearer(office, Scope.STOP)
    async with office.browser() as browser:
        myself = (await browser.get("/api/v1/me", headers=headers)).json()
        assert (await browser.get("/api/v1/trackers", headers=headers)).status_code == 403
    assert (myself["permissions"], myself["trackers"]) == (["known", "open", "stop"], ["T2"])


async def test_who_makes_a_token_is_told_its_id_and_can_revoke_it(office: Office) -> None:
    async with office.browser(await office.session("administrator")) as browser:
        made = (await browser.post("/api/v1/tokens", json={"name": "plc", "scopes": ["stop"]})).json()
        listed = (await browser.get("/api/v1/tokens")).json()["items"]
        assert [one["token_id"] for one in listed] == [made["token_id"]]
        gone = await browser.delete(f"/api/v1/tokens/{made['token_id']}")
    assert gone.status_code == 204
