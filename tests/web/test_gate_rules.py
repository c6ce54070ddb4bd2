"""What the gate reads of a request: what was brought along, from where, by which page, and the way back."""

from datetime import timedelta
from typing import Any

import pytest
from starlette.requests import Request

from app.access.authenticator import Credentials
from app.access.principal import NotAllowed, ProofNeeded, SignInNeeded
from app.web.http.errors import Busy, NotAcceptable, NotSetUp
from app.web.http.gate import (
    LONGEST_BACK,
    MOST_ADDRESSES,
    MOST_STOPS,
    OLD_PAGE,
    STOPS_WINDOW,
    StopLimit,
    asked,
    check_origin,
    cookie_name,
    credentials,
    is_activity,
    way_in,
)
from tests.fake_data import NOON
from tests.web.gatehouse import FAR, asked_for

A_MOMENT = timedelta(microseconds=1)


def test_stops_of_an_address_are_counted_for_a_second() -> None:
    limit = StopLimit()
    times = [NOON + number * timedelta(milliseconds=10) for number in range(MOST_STOPS)]
    assert all(limit.admit(FAR, at) for at in times)
    assert not limit.admit(FAR, times[-1])
    assert not limit.admit(FAR, NOON + STOPS_WINDOW - A_MOMENT)
    assert limit.admit(FAR, NOON + STOPS_WINDOW)
    assert not limit.admit(FAR, NOON + STOPS_WINDOW), "the second of them is not yet forgotten"
    assert all(limit.admit(FAR, NOON + 2 * STOPS_WINDOW) for _ in range(MOST_STOPS))
    assert not limit.admit(FAR, NOON + 2 * STOPS_WINDOW)


def test_a_clock_that_is_set_back_keeps_nobody_from_stopping() -> None:
    limit = StopLimit()
    assert all(limit.admit(FAR, NOON + timedelta(days=400)) for _ in range(MOST_STOPS))
    assert all(limit.admit(FAR, NOON) for _ in range(MOST_STOPS))
    assert not limit.admit(FAR, NOON)


def test_the_address_that_stopped_longest_ago_is_forgotten_first() -> None:
    limit = StopLimit()
    for _ in range(MOST_STOPS):
        limit.admit("first", NOON)
        limit.admit("second", NOON)
    assert not limit.admit("first", NOON), "asked again, it is not the oldest any more"
    for number in range(MOST_ADDRESSES - 2):
        assert limit.admit(str(number), NOON)
    assert not limit.admit("second", NOON), "so many addresses are remembered"
    assert not limit.admit("first", NOON)
    for number in range(MOST_ADDRESSES - 1):
        assert limit.admit(f"more {number}", NOON)
    assert not limit.admit("first", NOON)
    assert limit.admit("second", NOON), "it was forgotten"


def test_a_request_is_recorded_by_method_and_path() -> None:
    assert asked(asked_for("POST /stop", "stop_ticket=secret")) == "POST /stop"
    assert asked(asked_for("WS /live")) == "WS /live"


@pytest.mark.parametrize(
    ("scope", "found"),
    [
        (asked_for("GET /"), Credentials(FAR)),
        (asked_for("GET /") | {"client": None}, Credentials("")),
        (asked_for("GET /", cookie="a=b; heliopanel-8000=s"), Credentials(FAR, session_id="s")),
        (
            asked_for("GET /", cookie='layout={"rows": [1, 2]}; a b=1; heliopanel-8000=s'),
            Credentials(FAR, session_id="s"),
        ),
        (asked_for("GET /", cookie="heliopanel-8001=s"), Credentials(FAR)),
        (asked_for("GET /", "stop_ticket=k"), Credentials(FAR, stop_ticket="k")),
        (asked_for("GET /", "ticket=k"), Credentials(FAR)),
        (asked_for("GET /", authorization="Bearer  t "), Credentials(FAR, bearer="t")),
        (asked_for("GET /", authorization="bEARER t"), Credentials(FAR, bearer="t")),
        (asked_for("GET /", authorization="Bearer t u"), Credentials(FAR, bearer="t u")),
        (asked_for("GET /", authorization="Bearer"), Credentials(FAR, bearer="none")),
        (asked_for("GET /", authorization="Basic t", cookie="heliopanel-8000=s"), Credentials(FAR, "s")),
        (
            asked_for("GET /", "stop_ticket=k", authorization="Bearer t", cookie="heliopanel-8000=s"),
            Credentials(FAR, bearer="t"),
        ),
    ],
)
def test_what_is_brought_along_is_found(scope: dict[str, Any], found: Credentials) -> None:
    assert credentials(scope) == found


def test_a_ticket_counts_where_one_is_taken_and_needs_no_address_field_elsewhere() -> None:
    scope = asked_for("WS /live", "ticket=k")
    assert credentials(scope, ticketed=True) == Credentials(FAR, ticket="k")
    assert credentials(asked_for("WS /live"), ticketed=True) == Credentials(FAR)
    scope = asked_for("GET /")
    del scope["query_string"]
    assert credentials(scope) == Credentials(FAR)


@pytest.mark.parametrize(
    ("about", "name"),
    [
        ({"scheme": "http"}, "heliopanel-8000"),
        ({"scheme": "ws"}, "heliopanel-8000"),
        ({"scheme": "https"}, "__Host-heliopanel"),
        ({"scheme": "wss"}, "__Host-heliopanel"),
        ({"server": None}, "heliopanel-0"),
    ],
)
def test_the_cookie_is_bound_to_the_port_or_with_tls_to_the_host(about: dict[str, Any], name: str) -> None:
    assert cookie_name(asked_for("GET /") | about) == name


@pytest.mark.parametrize(
    ("key", "headers", "passes"),
    [
        ("GET /", {}, True),
        ("POST /", {}, False),
        ("WS /live", {}, False),
        ("POST /", {"origin": "http://here"}, True),
        ("WS /live", {"origin": "http://here"}, True),
        ("POST /", {"sec_fetch_site": "same-origin"}, True),
        ("POST /", {"origin": "http://here", "hx_request": "true"}, False),
        ("POST /", {"origin": "http://here", "hx_request": "false"}, True),
        ("POST /", {"origin": "http://here", "x_csrf_token": "wrong"}, False),
        ("POST /", {"x_csrf_token": "right"}, True),
        ("POST /", {"x_csrf_token": "right", "origin": "http://here", "hx_request": "true"}, True),
    ],
)
def test_a_change_comes_from_a_page_of_this_panel(key: str, headers: dict[str, str], passes: bool) -> None:
    scope = asked_for(key, **headers)
    if passes:
        check_origin(scope, "right")
    else:
        with pytest.raises(NotAllowed, match=OLD_PAGE):
            check_origin(scope, "right")


@pytest.mark.parametrize(
    ("scope", "route", "is_one"),
    [
        (asked_for("GET /"), "GET /", True),
        (asked_for("GET /", hx_request="true"), "GET /", False),
        (asked_for("POST /", hx_request="true"), "POST /", True),
        (asked_for("POST /"), "POST /", True),
        (asked_for("GET /s/panel.css"), "STATIC", False),
        (asked_for("WS /live"), "WS /live", False),
    ],
)
def test_a_change_or_an_opened_page_is_activity(scope: dict[str, Any], route: str, is_one: bool) -> None:
    assert is_activity(scope, route) is is_one


def way(key: str, error: Exception, **headers: str) -> tuple[int, str] | None:
    """Return status and address of the way in."""
    answer = way_in(Request(asked_for(key, **headers) | {"server": ("here", 80)}), error)
    if answer is None:
        return None
    return answer.status_code, answer.headers.get("location") or answer.headers["hx-redirect"]


SIGN_IN, PROVE, CLOSED = SignInNeeded(""), ProofNeeded(""), NotSetUp("")


@pytest.mark.parametrize(
    ("key", "error", "headers", "to"),
    [
        ("GET /trackers/T1", SIGN_IN, {}, (303, "/login?back=/trackers/T1")),
        ("GET /trackers/T1", PROVE, {}, (303, "/prove?back=/trackers/T1")),
        ("GET /trackers/T1", SIGN_IN, {"hx_request": "true"}, (204, "/login?back=/trackers/T1")),
        ("GET /trackers/T1", CLOSED, {}, (303, "/setup")),
        ("GET /a", PROVE, {"referer": "http://here/b"}, (303, "/prove?back=/a")),
        ("POST /a", PROVE, {"referer": "http://here/b/c"}, (303, "/prove?back=/b/c")),
        (
            "POST /a",
            PROVE,
            {"hx_current_url": "http://here/b//c", "referer": "x"},
            (303, "/prove?back=/b//c"),
        ),
        ("POST /a", PROVE, {"referer": "http://here"}, (303, "/prove?back=/")),
        ("POST /a", PROVE, {"referer": "nonsense"}, (303, "/prove?back=/")),
        ("POST /a", PROVE, {}, (303, "/prove?back=/")),
        ("GET /a", NotAllowed(""), {}, None),
        ("GET /a", Busy(""), {}, None),
        ("GET /a", NotAcceptable(""), {}, None),
        ("GET /api/v1/site", SIGN_IN, {}, None),
        ("GET /api/v1/site", CLOSED, {}, None),
    ],
)
def test_a_person_is_led_to_where_it_goes_on_and_back(
    key: str, error: Exception, headers: dict[str, str], to: tuple[int, str] | None
) -> None:
    assert way(key, error, **headers) == to


def test_of_a_long_way_back_the_fields_are_left_out() -> None:
    page = "/trackers/T1?f="
    longest = page + "x" * (LONGEST_BACK - len(page))
    kept = way("POST /a", PROVE, referer=f"http://here{longest}")
    assert kept == (303, f"/prove?back=/trackers/T1%3Ff%3D{'x' * (LONGEST_BACK - len(page))}")
    assert way("POST /a", PROVE, referer=f"http://here{longest}x?y") == (303, "/prove?back=/trackers/T1")
