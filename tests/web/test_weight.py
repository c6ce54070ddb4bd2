"""What is of weight wants a password typed within 5 minutes: every such route, told here once more."""

from datetime import timedelta

import pytest

from app.access.roles import GRANTS, Role
from tests.web.office import COOKIE, Office
from tests.web.route_table import ROUTES
from tests.web.test_gate_table import OWN, Answer, Doors

ACCOUNTS = [
    "POST /users",
    "POST /users/{name}/roles",
    "POST /users/{name}/password",
    "POST /users/{name}/remove",
    "POST /tokens",
    "POST /api/v1/users",
    "PATCH /api/v1/users/{name}",
    "DELETE /api/v1/users/{name}",
    "POST /api/v1/tokens",
]
NETWORK = ["GET /network", "POST /network", "PUT /api/v1/network"]
EVERYTHING = [
    "POST /restore",
    "POST /api/v1/backups",
    "POST /api/v1/backups/{name}/restore",
]
DRIVES_AND_LIMITS = [
    "POST /trackers/{tracker_id}/drive",
    "POST /trackers/{tracker_id}/drive/restore",
    "POST /trackers/{tracker_id}/mount/kind",
    "POST /trackers/{tracker_id}/settings/undo",
    "POST /api/v1/trackers/{tracker_id}/drive/undo",
    "POST /api/v1/trackers/{tracker_id}/settings/undo",
]
OF_WEIGHT = [*ACCOUNTS, *NETWORK, *EVERYTHING, *DRIVES_AND_LIMITS]
"""Written out, and not read from the table that the gate obeys: who takes one away there finds it here."""


async def signed_in(office: Office, role: Role) -> dict[str, str]:
    """Return what a page of a new session of this role sends."""
    session = await office.session(role)
    return OWN | {"cookie": f"{COOKIE}={session}", "x-csrf-token": office.keeper.csrf(session)}


def asks_for_the_password(answer: Answer) -> bool:
    """Return whether a page is led to the password, or a program told of it."""
    to = answer.headers.get("location", "") + answer.headers.get("hx-redirect", "")
    return to.startswith("/prove") or (answer.status == 403 and answer.headers.get("proof-needed") == "1")


def one_who_may(route: str) -> Role:
    """Return a role that the table lets through."""
    return next(role for role in Role if ROUTES[route] in GRANTS[role])


@pytest.mark.parametrize("route", OF_WEIGHT)
async def test_a_stale_session_is_asked_for_the_password(office: Office, route: str) -> None:
    doors, headers = Doors(office), await signed_in(office, one_who_may(route))
    assert (await doors.ask(route, headers)).status == 200
    office.clock.ahead = timedelta(minutes=5)
    asked = await doors.ask(route, headers)
    assert asks_for_the_password(asked), asked
    assert doors.inside.reached == 1, "nothing was done"


@pytest.mark.parametrize("role", Role)
async def test_nothing_else_asks_for_it(office: Office, role: Role) -> None:
    doors, headers = Doors(office), await signed_in(office, role)
    office.clock.ahead = timedelta(minutes=6)
    asking = {route for route in ROUTES if asks_for_the_password(await doors.ask(route, headers))}
    assert asking == {route for route in OF_WEIGHT if ROUTES[route] in GRANTS[role]}
