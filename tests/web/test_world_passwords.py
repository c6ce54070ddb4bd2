"""Passwords as keyboards compose them: what looks alike and is written alike is one password."""

from collections.abc import AsyncIterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from unicodedata import normalize

import httpx
import pytest
from typer.testing import CliRunner

from app.access.accounts import TokenWish
from app.access.passwords import LONGEST, Argon, Passwords, prepared, weakness
from app.access.roles import Role
from app.access.sessions import digest_of
from app.access.sign_in_errors import WrongPassword
from app.cli.users import users
from tests.access.door import HERE, Door
from tests.access.fake_hasher import FakeHasher
from tests.golden.table import rows
from tests.web.office import PASSWORD, Office

PASSWORDS = rows("world/passwords.csv")
NAME = "administrator-1"
API = "/api/v1"
Where = tuple[str, str, str, dict[str, Any]]
TYPED: list[Where] = [
    ("POST", "/login", "data", {"name": NAME, "password": None}),
    ("POST", f"{API}/session", "json", {"name": NAME, "password": None}),
    ("POST", "/prove", "data", {"password": None}),
    ("POST", f"{API}/session/reauthentication", "json", {"password": None}),
    ("POST", "/account/password", "data", {"old": None, "new": PASSWORD}),
    ("PUT", f"{API}/me/password", "json", {"old": None, "new": PASSWORD}),
]
"""Where a password is typed that was set before: it stands in the place of None."""
SET: list[tuple[str, Where]] = [
    ("zoe", ("POST", "/users", "data", {"name": "zoe", "role": "viewer", "password": None})),
    ("ada", ("POST", f"{API}/users", "json", {"name": "ada", "roles": ["viewer"], "password": None})),
    ("viewer-1", ("POST", "/users/viewer-1/password", "data", {"password": None})),
    ("operator-1", ("PATCH", f"{API}/users/operator-1", "json", {"password": None})),
    (NAME, ("POST", "/account/password", "data", {"old": PASSWORD, "new": None})),
    (NAME, ("PUT", f"{API}/me/password", "json", {"old": PASSWORD, "new": None})),
]
"""Where a password is set, and of which user."""
COMPOSED, DECOMPOSED = (normalize(form, "günlük-çağrı-ölçü-9") for form in ("NFC", "NFD"))


async def send(browser: httpx.AsyncClient, where: Where, text: str) -> int:
    method, path, kind, body = where
    sent = {name: text if value is None else value for name, value in body.items()}
    return (await browser.request(method, path, **{kind: sent})).status_code


@pytest.fixture
async def office(tmp_path: Path) -> Office:
    found = Office(tmp_path)
    await found.hire(Role.VIEWER, Role.OPERATOR)
    return found


@pytest.fixture
async def door(tmp_path: Path) -> AsyncIterator[Door]:
    made = Door(tmp_path)
    yield made
    made.keeper.close()


def hash_of(office: Office | Door, name: str = NAME) -> str:
    return office.keeper.book.users[name].password_hash


async def set_to(office: Office, text: str, session: str = "") -> None:
    now, accounts = office.clock.now(), office.keeper.accounts
    keep = digest_of(session) if session else ""
    await office.keeper.do(lambda: accounts.set_password(HERE, NAME, text, now, keep=keep))


@pytest.mark.parametrize("row", PASSWORDS, ids=lambda row: row["why"])
def test_a_password_is_right_however_it_is_composed(row: dict[str, str]) -> None:
    passwords = Passwords(FakeHasher())
    assert weakness(row["text"]) is None
    assert passwords.matches(passwords.hash(row["text"]), row["typed"]) == (row["outcome"] == "right")
    before = FakeHasher().hash(row["text"])
    assert passwords.matches(before, row["text"]), "a hash from before of exactly what was typed"


@pytest.mark.parametrize("where", TYPED, ids=lambda where: where[1])
async def test_every_field_for_a_password_takes_both_forms(where: Where, office: Office) -> None:
    session = await office.session(Role.ADMINISTRATOR)
    await set_to(office, COMPOSED, session)
    async with office.browser(session) as browser:
        assert await send(browser, where, COMPOSED.upper()) in (401, 422)
        assert await send(browser, where, DECOMPOSED) in (200, 204, 303)


async def test_every_field_that_sets_a_password_stores_one_form(office: Office) -> None:
    session = await office.session(Role.ADMINISTRATOR)
    async with office.browser(session) as browser:
        for name, where in SET:
            if name == NAME:
                await set_to(office, PASSWORD, session)
            assert await send(browser, where, DECOMPOSED) in (200, 201, 204, 303), where
            assert hash_of(office, name) == FakeHasher().hash(COMPOSED), where


async def test_the_first_administrator_signs_in_with_the_other_form(tmp_path: Path) -> None:
    door = Door(tmp_path, host="0.0.0.0")
    await door.keeper.set_up(door.keeper.setup.offer(), "ada", DECOMPOSED, "10.0.0.9")
    assert await door.tries("ada", COMPOSED)
    door.keeper.close()


@pytest.mark.parametrize("command", ["add", "reset"])
async def test_the_command_line_sets_the_same_password(
    door: Door, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    monkeypatch.setattr("app.cli.users.Argon", FakeHasher)
    monkeypatch.setenv("HELIOPANEL_DATA_DIR", str(tmp_path))
    if command == "reset":
        await door.add("ada", Role.ADMINISTRATOR)
    roles = ("--role", "administrator") if command == "add" else ()
    run = CliRunner().invoke(users, (command, "ada", *roles, "--password-stdin"), input=DECOMPOSED + "\n")
    assert run.exit_code == 0, run.output
    await door.keeper.refresh()
    assert hash_of(door, "ada") == FakeHasher().hash(COMPOSED)


def test_a_real_hash_takes_both_forms() -> None:
    passwords = Passwords(Argon())
    assert passwords.matches(passwords.hash(COMPOSED), DECOMPOSED)


@pytest.mark.parametrize(("stored", "typed"), [(COMPOSED, DECOMPOSED), (DECOMPOSED, COMPOSED)])
async def test_a_hash_from_before_takes_the_other_form_and_is_made_anew(
    stored: str, typed: str, office: Office
) -> None:
    def as_before() -> None:
        with office.keeper.accounts._store.writing() as change:
            user = change.users()[NAME]
            change.put_user(replace(user, password_hash=FakeHasher().hash(stored)))

    await office.keeper.do(as_before)
    roles = office.keeper.book.users[NAME].roles
    async with office.browser() as browser:
        assert await send(browser, TYPED[0], typed) == 303
        assert hash_of(office) == FakeHasher().hash(COMPOSED)
        assert await send(browser, TYPED[0], stored) == 303
    assert office.keeper.book.users[NAME].roles == roles


def test_a_hash_from_before_of_letters_that_grow_still_works_twice() -> None:
    passwords, text = Passwords(FakeHasher()), "\N{DEVANAGARI LETTER QA}" * LONGEST
    assert len(prepared(text)) == 2 * LONGEST
    assert passwords.matches(FakeHasher().hash(text), text)
    assert passwords.matches(passwords.hash_again(text), text)


@pytest.mark.parametrize("typed", [PASSWORD + "x", COMPOSED, DECOMPOSED])
def test_an_unknown_name_takes_the_work_of_a_known_one_in_every_form(typed: str) -> None:
    hasher = FakeHasher()
    passwords = Passwords(hasher)
    stored = passwords.hash(PASSWORD)
    assert not passwords.matches(stored, typed)
    known, hasher.checked = hasher.checked, 0
    assert not passwords.matches(None, typed)
    assert hasher.checked == known


def test_the_length_counts_letters_as_people_see_them() -> None:
    letters = "ảấộữịèôẽùâẻq"
    assert len(letters) == 12
    passwords = Passwords(FakeHasher())
    assert passwords.hash(normalize("NFD", letters)) == passwords.hash(letters)
    assert passwords.matches(passwords.hash(letters * 10), normalize("NFD", letters * 10))


@pytest.mark.parametrize(
    ("made", "typed"), [("270441", "٢٧٠٤٤١"), ("٢٧٠٤٤١", "270441"), ("２７０４４１", "270441")]
)
async def test_a_pin_is_right_with_the_digits_of_any_keyboard(door: Door, made: str, typed: str) -> None:
    await door.add("ada", Role.ADMINISTRATOR)
    token = await door.mint(TokenWish("gate 3", pin=made))
    who = door.who(await door.keeper.log_in_kiosk(token, "10.0.0.9", "panel"))
    with pytest.raises(WrongPassword):
        await door.keeper.step_up(who, "270442")
    await door.keeper.step_up(who, typed)
