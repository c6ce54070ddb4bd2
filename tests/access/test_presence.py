"""Who is let in, stays and must leave: sessions, the panel of a cabinet, stop tickets."""

import asyncio
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest

from app.access.access_cache import RESTING
from app.access.accounts import TokenWish
from app.access.authenticator import LOOK_EVERY, MOST_WAITING, WRONG_AT_ONCE, Credentials
from app.access.principal import SignInNeeded, Via, nobody
from app.access.roles import NOBODY, Role
from app.access.sessions import PROOF, digest_of, is_proven
from app.access.setup import CODE_FILE
from app.access.sign_in_errors import Throttled, TooManyAtOnce, WrongPassword
from app.access.tokens import Scope
from app.access.users import AccessRefused
from app.base.permission import Permission
from tests.access.door import ADDRESS, HERE, PASSWORD, START, Door
from tests.patience import PATIENCE_S

OTHER = "quiet-lantern-meadow-4"
PIN = "270441"


async def cabinet(door: Door, trackers: frozenset[str] | None = None) -> str:
    """Return the session of a cabinet's panel."""
    token = await door.mint(TokenWish("gate 3", trackers=trackers, pin=PIN))
    return await door.keeper.log_in_kiosk(f" {token} ", ADDRESS, "panel")


async def test_a_person_who_is_let_in_is_known_with_everything_about_them(door: Door) -> None:
    session = await door.keeper.log_in(" ADA ", PASSWORD, "c" * 80, "browser " * 30)
    who, kept = door.who(session), door.keeper.book.sessions[digest_of(session)]
    assert (who.name, who.roles, who.via, who.address) == ("ada", {Role.ADMINISTRATOR}, Via.SESSION, ADDRESS)
    assert (who.credential, who.proven_at, who.rests, who.trackers) == (kept.digest, START, False, None)
    assert (kept.address, kept.agent) == ("c" * 64, ("browser " * 30)[:120])
    assert (kept.user, kept.token_id, kept.began_at, kept.used_at) == ("ada", "", START, START)
    assert door.keeper.csrf(session) != door.keeper.csrf(session + "x")


async def test_a_session_that_ended_is_nobody_at_the_same_address(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)
    who = door.who(session)
    assert door.keeper.current(who) == who
    await door.keeper.log_out(who)
    assert door.keeper.current(who) == nobody(ADDRESS)
    with pytest.raises(SignInNeeded, match="has ended"):
        await door.keeper.prove(who, PASSWORD)
    ended = (await door.recorded())[-1]
    assert (ended.actor, ended.action, ended.object) == ("ada", "session_ended", who.credential[:8])


async def test_logging_out_of_no_session_changes_nothing(door: Door) -> None:
    before = len(await door.recorded())
    text = await door.mint(TokenWish("scada", frozenset({Scope.READ})))
    await door.keeper.log_out(door.keeper.identify(Credentials(ADDRESS, bearer=text)))
    await door.keeper.log_out(nobody(ADDRESS))
    assert len(await door.recorded()) == before + 1


async def test_everybody_sees_and_ends_their_own_sessions_alone(door: Door) -> None:
    await door.add("olga", Role.OPERATOR)
    first = await door.tries("olga", PASSWORD)
    door.clock.advance(timedelta(seconds=1))
    second, others = await door.tries("olga", PASSWORD), await door.tries("ada", PASSWORD)
    olga = door.who(second)
    assert [one.digest for one in door.keeper.own_sessions(olga)] == [digest_of(second), digest_of(first)]
    await door.keeper.end_own_session(olga, digest_of(others))
    await door.keeper.end_own_session(olga, "no digest")
    assert door.via(others) is Via.SESSION
    await door.keeper.end_own_session(olga, digest_of(first))
    assert (door.via(first), door.via(second)) == (Via.NOBODY, Via.SESSION)
    ended = (await door.recorded())[-1]
    assert (ended.actor, ended.action, ended.at) == ("olga", "session_ended", door.clock.now())


async def test_a_program_of_a_persons_name_has_none_of_their_sessions(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)
    text = await door.mint(TokenWish("ada", frozenset({Scope.CONFIG})))
    program = door.keeper.identify(Credentials(ADDRESS, bearer=text))
    assert program.name == "ada"
    assert door.keeper.own_sessions(program) == ()
    await door.keeper.end_own_session(program, digest_of(session))
    assert door.via(session) is Via.SESSION


async def test_the_password_is_fresh_for_five_minutes_and_typed_again_for_five_more(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)
    assert not is_proven(door.who(session).proven_at, START + PROOF)
    assert door.who(session).may(Permission.ADMINISTER)
    door.clock.advance(timedelta(minutes=31))
    assert door.who(session).rests
    assert door.who(session).permissions == RESTING
    with pytest.raises(WrongPassword):
        await door.keeper.prove(door.who(session), "wrong wrong wrong")
    await door.keeper.prove(door.who(session), PASSWORD)
    assert (door.who(session).proven_at, door.who(session).rests) == (door.clock.now(), False)


async def test_mistakes_in_a_session_are_counted_for_it_alone(door: Door) -> None:
    """So nobody elsewhere waits for them, and they do not wait for mistakes elsewhere."""
    session = await door.tries("ada", PASSWORD)
    for _ in range(3):
        with pytest.raises(WrongPassword):
            await door.keeper.prove(door.who(session), "wrong wrong wrong")
    with pytest.raises(Throttled):
        await door.keeper.prove(door.who(session), PASSWORD)
    with pytest.raises(Throttled):
        await door.keeper.change_own_password(door.who(session), PASSWORD, OTHER)
    assert await door.tries("ada", PASSWORD)
    door.clock.advance(timedelta(seconds=30))
    with pytest.raises(WrongPassword):
        await door.keeper.change_own_password(door.who(session), "wrong wrong wrong", OTHER)
    assert door.via(session) is Via.SESSION


async def test_activity_is_noted_once_a_minute_of_people_who_do_not_rest(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)

    def noted() -> timedelta:
        return door.keeper.book.sessions[digest_of(session)].used_at - START

    door.clock.advance(timedelta(seconds=59))
    await door.keeper.used(door.who(session))
    assert noted() == timedelta()
    door.clock.advance(timedelta(seconds=1))
    await door.keeper.used(door.who(session))
    assert noted() == timedelta(minutes=1)
    door.clock.advance(timedelta(minutes=30))
    await door.keeper.used(door.who(session))
    assert noted() == timedelta(minutes=1), "whoever rests types the password first"
    await door.keeper.used(nobody(ADDRESS))


async def test_the_panel_of_a_cabinet_is_its_token(door: Door) -> None:
    session = await cabinet(door, frozenset({"T3"}))
    who = door.who(session)
    assert (who.name, who.roles, who.via, who.address) == ("gate 3", {Role.VIEWER}, Via.KIOSK, ADDRESS)
    assert (who.trackers, who.credential) == ({"T3"}, digest_of(session))
    greeted = (await door.recorded())[-1]
    assert (greeted.actor, greeted.action, greeted.object) == ("gate 3", "log_in", "gate 3")
    await door.keeper.step_up(who, PIN)
    assert door.who(session).roles == {Role.OPERATOR}
    stepped = (await door.recorded())[-1]
    assert (stepped.actor, stepped.via, stepped.address) == ("gate 3 (kiosk)", "kiosk", ADDRESS)
    assert (stepped.action, stepped.object, stepped.at) == ("stepped_up", "gate 3", START)
    door.clock.advance(timedelta(minutes=5) - timedelta(microseconds=1))
    assert door.who(session).may(Permission.OPERATE)
    door.clock.advance(timedelta(microseconds=1))
    assert door.who(session).may(Permission.STOP)
    assert not door.who(session).may(Permission.OPERATE)
    door.clock.move_to(START + timedelta(days=90) - timedelta(microseconds=1))
    assert door.via(session) is Via.KIOSK
    assert door.keeper.current(who).via is Via.KIOSK
    door.clock.advance(timedelta(microseconds=1))
    assert door.via(session) is Via.NOBODY
    await door.keeper.used(who)


async def test_what_is_no_token_of_a_cabinet_opens_none(door: Door) -> None:
    lifetime = timedelta(hours=1)
    program = await door.mint(TokenWish("scada", frozenset({Scope.READ})))
    panel = await door.mint(TokenWish("gate 3", lifetime=lifetime, pin=PIN))
    other = await door.mint(TokenWish("gate 4", pin=PIN))
    tried = ("", "hp_", program, other[:-1], panel)
    for number, text in enumerate(tried):
        if text == panel:
            door.clock.advance(lifetime)
        with pytest.raises(WrongPassword):
            await door.keeper.log_in_kiosk(text, f"10.0.1.{number}", "panel")
        failed = (await door.recorded())[-1]
        assert (failed.action, failed.object, failed.result) == ("log_in", f"token@10.0.1.{number}", "wrong")
        assert (failed.address, failed.actor) == (f"10.0.1.{number}", "nobody")
    assert not door.keeper.book.sessions
    with pytest.raises(SignInNeeded):
        door.keeper.identify(Credentials(ADDRESS, bearer=other))


async def test_an_old_secret_of_a_token_with_the_same_id_opens_nothing(door: Door) -> None:
    """Its checksum is right: only the digest tells."""
    panel = await door.mint(TokenWish("gate 3", pin=PIN))
    book = door.keeper.book
    (token,) = book.tokens.values()
    door.keeper.book = replace(book, tokens={token.token_id: replace(token, digest="0" * 64)})
    with pytest.raises(WrongPassword):
        await door.keeper.log_in_kiosk(panel, ADDRESS, "panel")


async def test_wrong_pins_make_the_panel_wait_and_the_right_one_forgives_them(door: Door) -> None:
    session = await cabinet(door)
    who = door.who(session)
    for _ in range(2):
        with pytest.raises(WrongPassword):
            await door.keeper.step_up(who, "270442")
    failed = (await door.recorded())[-1]
    assert (failed.action, failed.object, failed.address) == ("log_in", "PIN of gate 3", ADDRESS)
    await door.keeper.step_up(who, PIN)
    for _ in range(3):
        with pytest.raises(WrongPassword):
            await door.keeper.step_up(who, "270442")
    with pytest.raises(Throttled, match="Wait 1 s"):
        await door.keeper.step_up(who, PIN)
    (refused,) = door.keeper.refusals.take(door.clock.now())
    assert (refused.actor, refused.action) == ("gate 3 (kiosk)", "refused_log_in")
    assert refused.object == f"pin:{next(iter(door.keeper.book.tokens))}"
    assert refused.at == door.clock.now()
    assert refused.result == "There were too many wrong passwords. Wait 1 s, then try again."


async def test_a_person_has_no_pin(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)
    with pytest.raises(AccessRefused, match="A PIN works only on a cabinet display"):
        await door.keeper.step_up(door.who(session), PIN)


async def test_a_page_of_whoever_was_there_can_still_stop(door: Door) -> None:
    session = await door.tries("ada", PASSWORD)
    ticket = door.keeper.stop_ticket(door.who(session))
    found = door.keeper.identify(Credentials("10.0.0.7", stop_ticket=ticket))
    assert (found.name, found.via, found.address) == ("ada", Via.STOP_TICKET, "10.0.0.7")
    assert (found.permissions, found.roles) == (NOBODY | {Permission.STOP}, frozenset())
    assert door.keeper.current(found) == found
    assert door.keeper.identify(Credentials(ADDRESS, stop_ticket="rubbish")) == nobody(ADDRESS)
    assert door.keeper.identify(Credentials(ADDRESS)) == nobody(ADDRESS)
    door.clock.advance(timedelta(hours=24))
    assert door.keeper.identify(Credentials(ADDRESS, stop_ticket=ticket)) == nobody(ADDRESS)


async def test_a_one_shot_ticket_stands_for_whom_it_was_given(door: Door) -> None:
    who = door.who(await door.tries("ada", PASSWORD))
    ticket = door.keeper.ticket(who)
    assert door.keeper.identify(Credentials("10.0.0.7", ticket=ticket)) == who
    assert door.keeper.identify(Credentials("10.0.0.7", ticket=ticket)).via is Via.NOBODY


@pytest.mark.parametrize("address", ["127.0.0.1", "::1"])
async def test_this_computer_leaves_with_the_first_user(new_door: Door, address: str) -> None:
    here = new_door.keeper.identify(Credentials(address))
    assert (here.via, here.address) == (Via.LOOPBACK, address)
    assert new_door.keeper.current(here) == here
    await new_door.add("ada", Role.ADMINISTRATOR)
    assert new_door.keeper.current(here) == nobody(address)
    assert new_door.keeper.identify(Credentials(address)) == nobody(address)


async def test_wrong_set_up_codes_make_their_address_wait(tmp_path: Path) -> None:
    door = Door(tmp_path, host="0.0.0.0")
    code = (tmp_path / CODE_FILE).read_text().strip()
    for _ in range(3):
        with pytest.raises(WrongPassword):
            await door.keeper.set_up("AAAA-BBBB-CCCC-DDDD", "ada", PASSWORD, ADDRESS)
    with pytest.raises(Throttled):
        await door.keeper.set_up(code, "ada", PASSWORD, ADDRESS)
    (refused,) = door.keeper.refusals.take(door.clock.now())
    assert (refused.actor, refused.address, refused.object) == ("nobody", ADDRESS, "setup")
    await door.keeper.set_up(f" {code} ", "Ada", PASSWORD, "10.0.0.10")
    told = [(one.actor, one.address, one.action, one.object) for one in await door.recorded()]
    assert told == [("nobody", ADDRESS, "log_in", "setup code")] * 3 + [
        ("nobody", "10.0.0.10", "user_added", "ada: administrator")
    ]
    door.keeper.close()


async def test_guesses_are_recorded_one_by_one_until_there_are_too_many(door: Door) -> None:
    for number in range(WRONG_AT_ONCE + 1):
        with pytest.raises(WrongPassword):
            await door.tries(f"user{number}", "wrong wrong wrong", f"10.1.{number // 200}.{number % 200}")
    told = [one for one in await door.recorded() if one.result == "wrong"]
    assert len(told) == WRONG_AT_ONCE
    assert (told[-1].actor, told[-1].object, told[-1].address) == ("nobody", "user199", "10.1.0.199")
    (left_out,) = door.keeper.refusals.take(door.clock.now())
    assert left_out.result == "1 refusals were not recorded individually."
    door.clock.advance(timedelta(minutes=1))
    await door.fails("ada", "10.2.0.1")
    assert (await door.recorded())[-1].address == "10.2.0.1", "one more a minute"


async def test_twenty_may_wait_to_sign_in_and_one_more_is_told_so(door: Door) -> None:
    waiting = [asyncio.create_task(door.tries("ada", PASSWORD)) for _ in range(MOST_WAITING + 1)]
    ends = await asyncio.gather(*waiting, return_exceptions=True)
    assert [type(end) for end in ends] == [str] * MOST_WAITING + [TooManyAtOnce]
    assert await door.tries("ada", PASSWORD)


async def test_refusals_and_what_others_wrote_are_looked_at_twice_a_second(door: Door) -> None:
    running = asyncio.create_task(door.keeper.run())
    await asyncio.sleep(0)
    door.keeper.refusals.note("refused", nobody(ADDRESS), "POST /x", "No.", door.clock.now())
    other = Door(door.settings.data_dir)
    await other.add("olga", Role.OPERATOR)
    for _ in range(5):
        await asyncio.to_thread(int)
    assert "olga" not in door.keeper.book.users
    looked = asyncio.create_task(_changed(door))
    await asyncio.sleep(0)
    door.clock.advance(LOOK_EVERY)
    async with asyncio.timeout(PATIENCE_S):
        await looked
    assert "olga" in door.keeper.book.users
    last = (await door.recorded())[-1]
    assert (last.action, last.object, last.result) == ("refused", "POST /x", "No.")
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    other.keeper.close()


async def _changed(door: Door) -> None:
    await door.keeper._changed.wait()


async def test_events_are_told_in_pages_the_newest_first(door: Door) -> None:
    for number in range(5):
        door.keeper.accounts.record(HERE, "network_changed", str(number), START)
    newest = await door.keeper.events(None, 2)
    assert [one.event.object for one in newest] == ["4", "3"]
    older = await door.keeper.events(newest[-1].number, 2)
    assert [one.event.object for one in older] == ["2", "1"]


async def test_guesses_of_many_names_make_their_address_wait_and_of_one_name_every_address(
    door: Door,
) -> None:
    for name in ("bo", "cy", "di"):
        await door.fails(name, "10.0.0.66")
    with pytest.raises(Throttled):
        await door.tries("ed", "wrong wrong wrong", "10.0.0.66")
    for number in (1, 2, 3):
        await door.fails("ada", f"10.0.1.{number}")
    await door.fails("ada", "10.0.2.1")
    with pytest.raises(Throttled):
        await door.tries("ada", PASSWORD, "10.0.2.1")
    assert await door.tries("ada", PASSWORD, "10.0.2.2"), "a first try is always looked at"


async def test_a_browser_that_holds_a_session_waits_for_its_own_mistakes_alone(door: Door) -> None:
    held = await door.tries("ada", PASSWORD)
    for _ in range(3):
        with pytest.raises(WrongPassword):
            await door.keeper.log_in("ada", "wrong wrong wrong", ADDRESS, "test", held)
    with pytest.raises(Throttled):
        await door.keeper.log_in("ada", PASSWORD, ADDRESS, "test", held)
    assert await door.tries("ada", PASSWORD), "another browser at the same address does not"


async def test_who_was_let_in_is_judged_by_what_they_may_now(door: Door) -> None:
    await door.add("olga", Role.OPERATOR)
    who = door.who(await door.tries("olga", PASSWORD))
    staying = asyncio.create_task(door.keeper.until_gone(who))
    roles = {Role.VIEWER}
    await door.keeper.do(lambda: door.keeper.accounts.set_roles(HERE, "olga", roles, door.clock.now()))
    assert door.keeper.current(who).roles == roles
    await asyncio.sleep(0)
    assert not staying.done(), "other roles send nobody away"
    await door.keeper.log_out(who)
    async with asyncio.timeout(PATIENCE_S):
        await staying
