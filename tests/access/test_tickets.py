"""Tickets and tokens at their edges: how long, how many, whose, and by which bytes they are known."""

import base64
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest

from app.access.principal import Principal, Via
from app.access.roles import Role, permissions_of
from app.access.tickets import OneShots, csrf_token, read_stop_ticket, stop_ticket
from app.access.tokens import Scope, Token, digest_of, is_valid, mint

NOW = datetime(2026, 6, 21, 12, tzinfo=UTC)
KEY = bytes(range(32))
ROLES = frozenset({Role.OPERATOR})
ANA = Principal("ana", ROLES, permissions_of(ROLES), Via.SESSION, "192.0.2.7")


def test_the_oldest_of_more_than_a_thousand_one_shot_tickets_is_forgotten() -> None:
    shots = OneShots()
    issued = [shots.issue(ANA, NOW) for _ in range(1001)]
    assert len(set(issued)) == 1001
    assert all(len(ticket) == 43 for ticket in issued), "32 random bytes each"
    assert shots.redeem(issued[0], NOW) is None
    assert all(shots.redeem(ticket, NOW) == ANA for ticket in issued[1:])


def test_a_one_shot_ticket_ends_at_5_s_and_with_its_first_use() -> None:
    shots = OneShots()
    first, late = shots.issue(ANA, NOW), shots.issue(ANA, NOW)
    assert shots.redeem(first, NOW + timedelta(seconds=4.999)) == ANA
    assert shots.redeem(first, NOW) is None
    assert shots.redeem(late, NOW + timedelta(seconds=5)) is None


@pytest.mark.parametrize("name", ["ana", "a.b.c", "Ülkü", "."])
def test_a_stop_ticket_says_whose_it_is_and_ends_after_24_hours(name: str) -> None:
    ticket = stop_ticket(KEY, name, NOW)
    end = NOW + timedelta(hours=24)
    found = read_stop_ticket(KEY, ticket, end - timedelta(seconds=1))
    assert found is not None
    assert (found.name, found.until) == (name, end)
    assert read_stop_ticket(KEY, ticket, end) is None
    assert read_stop_ticket(bytes(32), ticket, NOW) is None
    assert "=" not in ticket


def test_a_stop_ticket_with_rubbish_in_it_is_none() -> None:
    ticket = stop_ticket(KEY, "ana", NOW)
    for spoiled in (
        ticket + "!",
        "!" + ticket,
        ticket.replace(".", "!.", 1),
        ticket + ".",
        ticket[:-1],
        "",
        ".",
        "a.b",
        "é.é",
        "AAAA.AAAA",
    ):
        assert read_stop_ticket(KEY, spoiled, NOW) is None, spoiled


def test_a_page_that_was_open_over_an_update_can_still_stop_and_send() -> None:
    """Both are known by these bytes: HMAC-SHA256 of `stop:` and `csrf:` before what is sealed."""
    body = f"{int((NOW + timedelta(hours=24)).timestamp())}.ana".encode()
    told, mac = stop_ticket(KEY, "ana", NOW).split(".")
    assert base64.urlsafe_b64decode(told + "==") == body
    assert mac == "bIgp523TnbLHgYsKlw9q-jfw4bRw5B_ic08rgbiaZq0"
    assert csrf_token(KEY, "a session") == "pkDy8hJdTdmiCfXXravAH1-7FEmBkt5aFDPeuRurb3Q"


def test_a_token_needs_its_own_text_and_ends_when_it_expires() -> None:
    token_id, text = mint()
    end = NOW + timedelta(days=1)
    token = Token(token_id, "script", "ana", digest_of(text), frozenset({Scope.READ}), None, NOW, end)
    _, other = mint()
    assert is_valid(token, text, token.expires_at - timedelta(microseconds=1))
    assert not is_valid(token, text, token.expires_at)
    assert not is_valid(token, text, token.expires_at + timedelta(days=1))
    assert not is_valid(token, other, NOW)
    assert not is_valid(replace(token, digest=""), text, NOW)
