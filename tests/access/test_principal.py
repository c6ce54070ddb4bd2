"""Who may do what, and the sentence that says why not."""

from datetime import UTC, datetime

import pytest

from app.access.principal import (
    NotAllowed,
    Principal,
    ProofNeeded,
    SignInNeeded,
    Via,
    nobody,
    this_computer,
)
from app.access.roles import Role, permissions_of
from app.base.permission import Permission
from app.link.orders import KINDS
from app.tracker.values.order_spec import OrderSpec

NOW = datetime(2026, 6, 21, 12, tzinfo=UTC)
ADDRESS = "192.0.2.7"


def person(*roles: Role, rests: bool = False) -> Principal:
    held = frozenset(roles)
    return Principal("ana", held, permissions_of(held), Via.SESSION, ADDRESS, rests=rests)


def token(*permissions: Permission, trackers: frozenset[str] | None = None) -> Principal:
    return Principal("script", frozenset(), frozenset(permissions), Via.TOKEN, ADDRESS, trackers=trackers)


def order_of(permission: Permission) -> OrderSpec:
    return next(one.spec for one in KINDS.values() if one.spec.needs is permission)


def test_who_may_not_order_is_told_who_may() -> None:
    with pytest.raises(NotAllowed, match="role is operator or engineer"):
        person(Role.VIEWER).require_order("move", order_of(Permission.OPERATE), "T1")
    person(Role.OPERATOR).require_order("move", order_of(Permission.OPERATE), "T1")


def test_a_limited_token_orders_its_own_trackers_and_stops_them_all() -> None:
    limited = token(Permission.OPERATE, Permission.STOP, trackers=frozenset({"T2"}))
    moving, stopping = order_of(Permission.OPERATE), order_of(Permission.STOP)
    assert limited.may_order(moving, "T2")
    limited.require_order("move", moving, "T2")
    for tracker_id in ("T1", None):
        assert not limited.may_order(moving, tracker_id)
        assert limited.may_order(stopping, tracker_id)
        with pytest.raises(NotAllowed):
            limited.require_order("move", moving, tracker_id)
    with pytest.raises(NotAllowed) as refused:
        limited.require_order("move", moving, "T1")
    assert str(refused.value) == "script may not access tracker T1; the token is for other trackers."


def test_whoever_is_not_known_is_asked_to_sign_in_first() -> None:
    with pytest.raises(SignInNeeded) as refused:
        nobody(ADDRESS).require(Permission.READ)
    assert str(refused.value) == ("Sign in first: Heliopanel shows and moves nothing for unknown users.")
    assert nobody(ADDRESS).address == ADDRESS


def test_rest_asks_for_the_password_only_of_whom_it_would_let() -> None:
    held = frozenset({Role.OPERATOR})
    resting = Principal("ana", held, frozenset({Permission.STOP}), Via.SESSION, ADDRESS, rests=True)
    with pytest.raises(ProofNeeded) as asked:
        resting.require(Permission.OPERATE)
    assert str(asked.value) == "There was no activity for 30 minutes. Enter your password to continue."
    with pytest.raises(NotAllowed):
        resting.require(Permission.ADMINISTER)
    awake = Principal("ana", held, frozenset({Permission.STOP}), Via.SESSION, ADDRESS)
    with pytest.raises(NotAllowed):
        awake.require(Permission.OPERATE)
    resting.require(Permission.STOP)


def test_a_refusal_says_who_asked_what_and_who_may() -> None:
    assert person(Role.VIEWER).refusal(Permission.ADMINISTER).startswith("ana (viewer) may not ")
    both = person(Role.VIEWER, Role.OPERATOR).refusal(Permission.ADMINISTER, "T1")
    assert both.startswith("ana (operator and viewer) may not ")
    assert both.endswith("Ask a user whose role is administrator.")
    ticket = Principal("ana", frozenset(), frozenset(), Via.STOP_TICKET, ADDRESS)
    assert ticket.refusal(Permission.OPERATE).startswith("ana (stop ticket) may not ")


def test_who_sits_at_the_computer_before_there_are_users() -> None:
    here = this_computer("127.0.0.1")
    assert (here.name, here.via, here.address) == ("local user", Via.LOOPBACK, "127.0.0.1")
    assert here.roles == frozenset({Role.ENGINEER, Role.ADMINISTRATOR})
    assert here.permissions == permissions_of(here.roles)
    assert here.is_known
