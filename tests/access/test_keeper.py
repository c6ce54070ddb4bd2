"""Signing in, guessing, revoking and the first run, on a virtual clock."""

import asyncio
import os
from datetime import timedelta
from pathlib import Path

import pytest
from click.testing import Result
from typer.testing import CliRunner

from app.access.authenticator import Credentials
from app.access.events import chained
from app.access.opening import open_store
from app.access.principal import Via
from app.access.roles import Role
from app.access.setup import CODE_FILE, RESET_FILE
from app.access.sign_in_errors import Throttled, WrongPassword
from app.audit.chain import FIRST
from app.base.permission import Permission
from app.cli.users import users
from tests.access.door import ADDRESS, PASSWORD, Door
from tests.amount import amount
from tests.fault_result import FaultResult
from tests.patience import PATIENCE_S


async def test_without_users_this_computer_may_everything_and_nothing_is_written(
    new_door: Door, tmp_path: Path
) -> None:
    who = new_door.keeper.identify(Credentials("127.0.0.1"))
    assert who.permissions >= set(Permission)
    assert new_door.keeper.identify(Credentials("10.0.0.9")).via is Via.NOBODY
    store = open_store(new_door.settings)
    assert not store.exists()
    store.close()
    assert os.listdir(tmp_path) == []


async def test_the_file_of_users_is_private_and_holds_no_secret(tmp_path: Path) -> None:
    door = Door(tmp_path)
    await door.add("ada", Role.ADMINISTRATOR)
    session = await door.tries("ada", PASSWORD)
    assert (tmp_path / "access.db").stat().st_mode & 0o077 == 0
    written = (tmp_path / "access.db").read_bytes()
    assert PASSWORD.encode() not in written
    assert session.encode() not in written
    door.keeper.close()


@pytest.mark.fault(64)
async def test_many_guesses_get_nowhere_and_lock_nobody_out(door: Door, fault: FaultResult) -> None:
    guesses = amount(250, 1000)
    at_home = await door.tries("ada", PASSWORD, "10.0.0.2")
    looked_at, longest_s = door.hasher.checked, 0.0
    for number in range(guesses):
        with pytest.raises((Throttled, WrongPassword)) as refused:
            await door.tries("ada", f"guess number {number}", "10.0.0.66")
        if isinstance(refused.value, Throttled):
            longest_s = max(longest_s, refused.value.wait.total_seconds())
        door.clock.advance(timedelta(seconds=1))
    assert guesses // 33 <= door.hasher.checked - looked_at <= guesses // 30 + 12
    assert door.via(at_home) is Via.SESSION
    assert await door.tries("ada", PASSWORD, "10.0.0.2")
    assert await door.tries("ada", PASSWORD, "10.0.0.77")
    assert 15.0 < longest_s <= 30.0
    fault.prevented(f"from the second wrong password on each waits longer, {longest_s:.0f} s at most")
    fault.shows(str(refused.value))
    fault.recovers("nothing was lost: who knows the password signs in, from elsewhere at once")


async def test_the_wait_survives_a_restart_and_is_told_in_seconds(
    tmp_path: Path, database: str | None
) -> None:
    door = Door(tmp_path, database)
    await door.add("ada", Role.ADMINISTRATOR)
    for _ in range(6):
        await door.fails("ada")
        door.clock.advance(timedelta(seconds=31))
    await door.fails("ada")
    again = Door(tmp_path, database, begins_at=door.clock.now())
    with pytest.raises(Throttled, match=r"Wait 16 s"):
        await again.tries("ada", PASSWORD)
    again.clock.advance(timedelta(seconds=30))
    assert await again.tries("ada", PASSWORD)
    again.keeper.close()
    door.keeper.close()


async def test_an_unknown_name_is_hashed_like_a_known_one(door: Door) -> None:
    await door.fails("ada", "10.0.0.3")
    made, checked = door.hasher.made, door.hasher.checked
    for name, address in (("ada", "10.0.0.4"), ("nobody-here", "10.0.0.5")):
        with pytest.raises(WrongPassword) as wrong:
            await door.tries(name, "wrong wrong wrong", address)
        assert str(wrong.value) == "The name or the password is wrong."
    assert (door.hasher.made - made, door.hasher.checked - checked) == (0, 2)


async def test_what_another_process_revokes_ends_here(tmp_path: Path, database: str | None) -> None:
    door = Door(tmp_path, database)
    await door.add("ada", Role.ADMINISTRATOR)
    session = await door.tries("ada", PASSWORD)
    who = door.keeper.identify(Credentials("10.0.0.9", session))
    waiting = asyncio.create_task(door.keeper.until_gone(who))
    other = open_store(door.settings)
    with other.writing() as change:
        change.end_sessions("ada")
    other.close()
    await door.keeper.refresh()
    async with asyncio.timeout(PATIENCE_S):
        await waiting
    assert door.via(session) is Via.NOBODY
    door.keeper.close()


async def test_a_panel_that_others_reach_is_set_up_with_the_code_of_its_console(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    door = Door(tmp_path, host="0.0.0.0")
    code_file = tmp_path / CODE_FILE
    code = code_file.read_text().strip()
    assert code in capsys.readouterr().err
    assert code_file.stat().st_mode & 0o077 == 0
    assert door.keeper.is_closed
    assert door.keeper.identify(Credentials("127.0.0.1")).via is Via.NOBODY
    with pytest.raises(WrongPassword):
        await door.keeper.set_up("AAAA-BBBB-CCCC-DDDD", "ada", PASSWORD, "10.0.0.9")
    await door.keeper.set_up(code.lower(), "ada", PASSWORD, "10.0.0.9")
    assert not door.keeper.is_closed
    assert not code_file.exists()
    with pytest.raises(WrongPassword):
        await door.keeper.set_up(code, "eve", PASSWORD, "10.0.0.9")
    door.keeper.close()


async def test_a_file_in_the_data_folder_resets_access_and_the_events_stay_chained(
    tmp_path: Path, database: str | None
) -> None:
    door = Door(tmp_path, database)
    await door.add("ada", Role.ADMINISTRATOR)
    (tmp_path / RESET_FILE).touch()
    again = Door(tmp_path, database)
    assert not again.keeper.book.users
    assert not (tmp_path / RESET_FILE).exists()
    store = open_store(door.settings)
    events = store.events()
    assert [event.action for event, _, _ in events] == ["user_added", "factory_reset"]
    previous = FIRST
    for event, before, own in events:
        assert before == previous
        assert own == chained(previous, event)
        previous = own
    store.close()
    again.keeper.close()
    door.keeper.close()


def test_the_command_line_adds_lists_and_removes(tmp_path: Path) -> None:
    def run(*arguments: str, typed: str = "") -> Result:
        return CliRunner().invoke(users, arguments, input=typed, env={"HELIOPANEL_DATA_DIR": str(tmp_path)})

    added = run("add", "ada", "--role", "administrator", "--password-stdin", typed=PASSWORD + "\n")
    assert added.exit_code == 0, added.output
    weak = run("reset", "ada", "--password-stdin", typed="solartracker\n")
    assert isinstance(weak.exception, ValueError)
    assert "is easy to guess" in str(weak.exception)
    listed = run("list").output
    assert "ada" in listed
    assert "administrator" in listed
    asked = run("reset", "ada", typed=f"{PASSWORD}\n{PASSWORD}\n")
    assert asked.exit_code == 0, asked.output
    assert PASSWORD not in asked.output
    assert run("remove", "ada").exit_code == 0
    assert "no users" in run("list").output


async def test_a_new_password_from_the_console_lets_its_user_in_at_once(tmp_path: Path) -> None:
    door = Door(tmp_path)
    await door.add("ada", Role.ADMINISTRATOR)
    await door.add("a_a", Role.VIEWER)
    for name in ("a_a", *["ada"] * 3, "ada_1"):
        for _ in range(3):
            with pytest.raises((WrongPassword, Throttled)):
                await door.tries(name, "wrong wrong wrong")
            door.clock.advance(timedelta(seconds=10))
    with pytest.raises((WrongPassword, Throttled)):
        await door.tries("ada", "wrong wrong wrong")
    with pytest.raises(Throttled):
        await door.tries("ada", PASSWORD)
    typed, environment = PASSWORD + "\n", {"HELIOPANEL_DATA_DIR": str(tmp_path)}
    reset = CliRunner().invoke(users, ("reset", "ADA", "--password-stdin"), input=typed, env=environment)
    assert reset.exit_code == 0, reset.output
    assert door.via(await door.tries("ada", PASSWORD)) is Via.SESSION
    here = {name: f"{name}@{ADDRESS}" for name in ("ada", "a_a", "ada_1")}
    store = open_store(door.settings)
    left = store.failures([*here.values(), f"address:{ADDRESS}", "account:ada", "account:a_a"])
    assert set(left) == {here["a_a"], here["ada_1"], "account:a_a"}
    store.close()
    door.keeper.close()
