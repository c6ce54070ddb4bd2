"""What is changed about people and tokens: what is stored of it, and what the record of access says."""

from datetime import timedelta

import pytest

from app.access.accounts import TokenWish
from app.access.authenticator import Credentials
from app.access.events import AccessEvent
from app.access.principal import Principal, Via, nobody
from app.access.roles import Role
from app.access.tokens import Scope, digest_of, permissions_of, token_id_of
from app.access.users import AccessRefused
from app.base.permission import Permission
from tests.access.door import ADDRESS, HERE, PASSWORD, START, Door

OTHER = "quiet-lantern-meadow-4"
READ = frozenset({Scope.READ})
FAR = Principal("a" * 200, frozenset(), frozenset(), Via.SESSION, "b" * 200)


def said(event: AccessEvent) -> tuple[str, str, str, str, str, str]:
    return event.actor, event.via, event.address, event.action, event.object, event.result


async def test_every_change_is_recorded_with_who_when_and_what(door: Door) -> None:
    accounts, clock = door.keeper.accounts, door.clock
    await door.add("olga", Role.OPERATOR, Role.VIEWER)
    session = await door.tries("olga", PASSWORD)
    clock.advance(timedelta(minutes=1))
    now = clock.now()
    accounts.set_roles(HERE, "OLGA", [Role.ENGINEER], now)
    accounts.set_password(HERE, "OLGA", OTHER, now)
    token_id = token_id_of(accounts.mint(HERE, TokenWish(" scada ", READ | {Scope.STOP}), now))
    kiosk_id = token_id_of(accounts.mint(HERE, TokenWish("gate 3", pin="270441"), now))
    accounts.end_session(HERE, digest_of(session), now)
    accounts.revoke(HERE, token_id or "", now)
    accounts.remove(HERE, "OLGA", now)
    accounts.record(HERE, "network_changed", "port 8001", now)
    accounts.record(HERE, "network_changed", "port 8002", now, "refused")
    accounts.factory_reset(HERE, now)
    by = ("local user", "loopback", "127.0.0.1")
    told = await door.recorded()
    assert [said(one) for one in told] == [
        (*by, "user_added", "ada: administrator", "done"),
        (*by, "user_added", "olga: operator, viewer", "done"),
        ("olga", "session", ADDRESS, "log_in", "olga", "done"),
        (*by, "roles_changed", "olga: operator, viewer -> engineer", "done"),
        (*by, "password_changed", "olga", "done"),
        (*by, "token_made", f"scada ({token_id}): read, stop", "done"),
        (*by, "token_made", f"gate 3 ({kiosk_id}): kiosk", "done"),
        (*by, "session_ended", digest_of(session)[:8], "done"),
        (*by, "token_revoked", token_id, "done"),
        (*by, "user_removed", "olga", "done"),
        (*by, "network_changed", "port 8001", "done"),
        (*by, "network_changed", "port 8002", "refused"),
        (*by, "factory_reset", "all users, sessions and tokens", "done"),
    ]
    assert [one.at for one in told] == [START] * 3 + [now] * 10


async def test_what_is_recorded_is_cut_to_what_its_columns_hold(door: Door) -> None:
    door.keeper.accounts.record(FAR, "network_changed", "c" * 200, START)
    text = door.keeper.accounts.mint(FAR, TokenWish("d" * 64, frozenset(Scope)), START)
    cut, made = (await door.recorded())[-2:]
    assert (cut.actor, cut.address, cut.object) == ("a" * 100, "b" * 64, "c" * 100)
    assert made.object == f"{'d' * 64} ({token_id_of(text)}): config, motion, read, stop"[:100]
    await door.keeper.refresh()
    assert door.keeper.book.tokens[token_id_of(text) or ""].owner == "a" * 32


async def test_other_roles_count_at_once_and_nothing_else_of_the_user_changes(door: Door) -> None:
    await door.add("olga", Role.OPERATOR)
    before, session = door.keeper.book.users["olga"], await door.tries("olga", PASSWORD)
    assert (before.created_at, before.changed_at) == (START, START)
    later = START + timedelta(minutes=3)
    door.clock.move_to(later)
    await door.keeper.do(lambda: door.keeper.accounts.set_roles(HERE, "Olga", [Role.VIEWER], later))
    after = door.keeper.book.users["olga"]
    assert (after.roles, after.created_at, after.changed_at) == ({Role.VIEWER}, START, later)
    assert after.password_hash == before.password_hash
    assert not door.who(session).may(Permission.OPERATE)
    with pytest.raises(AccessRefused, match="There is no user eve"):
        door.keeper.accounts.set_roles(HERE, "eve", [Role.VIEWER], later)


async def test_a_password_that_is_made_of_the_users_name_is_refused_however_it_is_typed(door: Door) -> None:
    await door.add("mirabelle", Role.VIEWER)
    for typed in ("mirabelle", "MIRABELLE"):
        with pytest.raises(AccessRefused, match="is easy to guess"):
            door.keeper.accounts.set_password(HERE, typed, "mirabelle2026!", START)
    with pytest.raises(AccessRefused, match="is easy to guess"):
        door.keeper.accounts.add(HERE, "Rosalind", [Role.VIEWER], "rosalind2026!", START)


async def test_a_new_password_keeps_the_session_that_it_was_changed_in(door: Door) -> None:
    here, elsewhere = await door.tries("ada", PASSWORD), await door.tries("ada", PASSWORD)
    door.clock.advance(timedelta(minutes=2))
    await door.keeper.change_own_password(door.who(here), PASSWORD, OTHER)
    assert (door.via(here), door.via(elsewhere)) == (Via.SESSION, Via.NOBODY)
    assert door.keeper.book.users["ada"].changed_at == door.clock.now()
    changed = (await door.recorded())[-1]
    assert said(changed) == ("ada", "session", ADDRESS, "password_changed", "ada", "done")
    assert await door.tries("ada", OTHER)
    now = door.clock.now()
    await door.keeper.do(lambda: door.keeper.accounts.set_password(HERE, "ada", PASSWORD, now))
    assert door.via(here) is Via.NOBODY, "another's change ends them all"


async def test_the_first_user_is_an_administrator_and_the_last_one_stays(
    new_door: Door,
) -> None:
    accounts = new_door.keeper.accounts
    with pytest.raises(AccessRefused, match="first user"):
        await new_door.add("olga", Role.OPERATOR)
    await new_door.add("ada", Role.ADMINISTRATOR)
    await new_door.add("olga", Role.OPERATOR)
    with pytest.raises(AccessRefused, match="at least one administrator"):
        accounts.set_roles(HERE, "ada", {Role.VIEWER}, START)
    with pytest.raises(AccessRefused, match="at least one administrator"):
        accounts.remove(HERE, "ada", START, last=True)
    accounts.remove(HERE, "olga", START)
    with pytest.raises(AccessRefused, match="at least one administrator"):
        accounts.remove(HERE, "ada", START)
    await new_door.keeper.do(lambda: accounts.remove(HERE, "ada", START, last=True))
    assert not new_door.keeper.book.users
    with pytest.raises(AccessRefused, match="There is no user ada"):
        accounts.remove(HERE, "ada", START)


async def test_a_removed_user_leaves_no_session_and_no_token(door: Door) -> None:
    await door.add("olga", Role.ENGINEER)
    session = await door.tries("olga", PASSWORD)
    text = await door.mint(TokenWish("hers", READ), door.who(session))
    await door.keeper.do(lambda: door.keeper.accounts.remove(HERE, "olga", START))
    assert (door.keeper.book.sessions, door.keeper.book.tokens) == ({}, {})
    with pytest.raises(Exception, match="unknown, revoked or has expired"):
        door.keeper.identify(Credentials(ADDRESS, bearer=text))


@pytest.mark.parametrize(
    ("name", "lifetime"),
    [("a", timedelta(hours=1)), ("a" * 64, timedelta(days=366)), ("  scada  ", timedelta(days=1))],
)
async def test_a_token_is_stored_as_it_was_wished(door: Door, name: str, lifetime: timedelta) -> None:
    text = await door.mint(TokenWish(name, READ, frozenset({"T1", "T2"}), lifetime))
    token = door.keeper.book.tokens[token_id_of(text) or ""]
    assert (token.name, token.owner, token.digest) == (name.strip(), "local user", digest_of(text))
    assert (token.scopes, token.trackers, token.pin_hash) == (READ, {"T1", "T2"}, "")
    assert (token.created_at, token.expires_at) == (START, START + lifetime)
    who = door.keeper.identify(Credentials(ADDRESS, bearer=text))
    assert (who.name, who.via, who.address, who.trackers) == (
        name.strip(), Via.TOKEN, ADDRESS, {"T1", "T2"},
    )  # fmt: skip
    assert (who.roles, who.credential) == (frozenset(), token.token_id)
    assert who.permissions == permissions_of(READ)


@pytest.mark.parametrize(
    ("wish", "why"),
    [
        (TokenWish("  ", READ), "1 to 64 characters"),
        (TokenWish("a" * 65, READ), "1 to 64 characters"),
        (TokenWish("scada"), "the purpose of the token: read, stop, motion, config"),
        (TokenWish("scada", READ, lifetime=timedelta(minutes=59)), "1 hour to 366 days"),
        (TokenWish("scada", READ, lifetime=timedelta(days=366, seconds=1)), "1 hour to 366 days"),
        (TokenWish("gate", pin="111222"), "A PIN has"),
    ],
)
async def test_a_token_that_cannot_be_is_refused_and_not_stored(
    door: Door, wish: TokenWish, why: str
) -> None:
    with pytest.raises(AccessRefused, match=why):
        await door.mint(wish)
    assert not door.keeper.book.tokens


async def test_a_token_ends_when_it_is_revoked_and_when_its_time_is_over(door: Door) -> None:
    texts = [await door.mint(TokenWish(name, READ, lifetime=timedelta(hours=1))) for name in ("one", "two")]
    one, two = (door.keeper.identify(Credentials(ADDRESS, bearer=text)) for text in texts)
    assert door.keeper.current(one) == one
    await door.keeper.do(lambda: door.keeper.accounts.revoke(HERE, one.credential, START))
    assert door.keeper.current(one) == nobody(ADDRESS)
    door.clock.advance(timedelta(minutes=59, seconds=59))
    assert door.keeper.current(two) == two
    door.clock.advance(timedelta(seconds=1))
    assert door.keeper.current(two) == nobody(ADDRESS)
    with pytest.raises(Exception, match="unknown, revoked or has expired"):
        door.keeper.identify(Credentials(ADDRESS, bearer=texts[1]))
