"""Passwords as keyboards compose them: what looks alike and is written alike is one password."""

from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
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
Sends = Callable[[httpx.AsyncClient, str], Awaitable[httpx.Response]]

TYPED: dict[str, Sends] = {
    "the page to sign in": lambda by, text: by.post("/login", data={"name": NAME, "password": text}),
    "the session of the API": lambda by, text: by.post(
        f"{API}/session", json={"name": NAME, "password": text}
    ),
    "the password again": lambda by, text: by.post("/prove", data={"password": text}),
    "the password again, by the API": lambda by, text: by.post(
        f"{API}/session/reauthentication", json={"password": text}
    ),
    "the old password": lambda by, text: by.post("/account/password", data={"old": text, "new": PASSWORD}),
    "the old password, by the API": lambda by, text: by.put(
        f"{API}/me/password", json={"old": text, "new": PASSWORD}
    ),
}
"""Where a password is typed that was set before."""
SET: dict[str, Sends] = {
    "a new user": lambda by, text: by.post(
        "/users", data={"name": "zoe", "role": "viewer", "password": text}
    ),
    "a new user, by the API": lambda by, text: by.post(
        f"{API}/users", json={"name": "zoe", "roles": ["viewer"], "password": text}
    ),
    "the password of a user": lambda by, text: by.post("/users/viewer-1/password", data={"password": text}),
    "the password of a user, by the API": lambda by, text: by.patch(
        f"{API}/users/viewer-1", json={"password": text}
    ),
    "the own password": lambda by, text: by.post("/account/password", data={"old": PASSWORD, "new": text}),
    "the own password, by the API": lambda by, text: by.put(
        f"{API}/me/password", json={"old": PASSWORD, "new": text}
    ),
}
"""Where a password is set, for which user."""
WHOSE = {"a": "zoe", "the": "viewer-1"}
COMPOSED, DECOMPOSED = (normalize(form, "günlük-çağrı-ölçü-9") for form in ("NFC", "NFD"))


@pytest.fixture
async def office(tmp_path: Path) -> Office:
    found = Office(tmp_path)
    await found.hire(Role.VIEWER)
    return found


def hash_of(office: Office | Door, name: str = NAME) -> str:
    return office.keeper.book.users[name].password_hash


async def as_before(office: Office, text: str) -> None:
    """Store a hash of exactly what was typed, as it was done once."""

    def work() -> None:
        with office.keeper.accounts._store.writing() as change:
            user = change.users()[NAME]
            change.put_user(replace(user, password_hash=FakeHasher().hash(text)))

    await office.keeper.do(work)


@pytest.mark.parametrize("row", PASSWORDS, ids=lambda row: row["why"])
async def test_a_password_is_right_however_it_is_composed(row: dict[str, str], office: Office) -> None:
    now = office.clock.now()
    accounts = office.keeper.accounts
    await office.keeper.do(lambda: accounts.set_password(HERE, NAME, row["text"], now))
    async with office.browser() as browser:
        answer = await TYPED["the page to sign in"](browser, row["typed"])
    assert answer.status_code == (303 if row["outcome"] == "right" else 401)


@pytest.mark.parametrize("where", TYPED)
async def test_every_field_for_a_password_takes_both_forms(where: str, office: Office) -> None:
    session = await office.session(Role.ADMINISTRATOR)
    now = office.clock.now()
    accounts = office.keeper.accounts
    keep = digest_of(session)
    await office.keeper.do(lambda: accounts.set_password(HERE, NAME, COMPOSED, now, keep=keep))
    async with office.browser(session) as browser:
        assert (await TYPED[where](browser, COMPOSED.upper())).status_code in (401, 422)
        answer = await TYPED[where](browser, DECOMPOSED)
    assert answer.status_code in (200, 204, 303), answer.text


@pytest.mark.parametrize("where", SET)
async def test_every_field_that_sets_a_password_stores_one_form(where: str, office: Office) -> None:
    session = await office.session(Role.ADMINISTRATOR)
    async with office.browser(session) as browser:
        answer = await SET[where](browser, DECOMPOSED)
    assert answer.status_code in (200, 201, 204, 303), answer.text
    name = NAME if "own" in where else WHOSE[where.split()[0]]
    assert hash_of(office, name) == FakeHasher().hash(COMPOSED)


async def test_the_first_administrator_signs_in_with_the_other_form(tmp_path: Path) -> None:
    door = Door(tmp_path, host="0.0.0.0")
    await door.keeper.set_up(door.keeper.setup.offer(), "ada", DECOMPOSED, "10.0.0.9")
    assert await door.tries("ada", COMPOSED)
    door.keeper.close()


@pytest.mark.parametrize("command", ["add", "reset"])
async def test_the_command_line_sets_the_same_password(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    door = Door(tmp_path)
    monkeypatch.setattr("app.cli.users.Argon", FakeHasher)
    if command == "reset":
        await door.add("ada", Role.ADMINISTRATOR)
    roles = ("--role", "administrator") if command == "add" else ()
    run = CliRunner().invoke(
        users,
        (command, "ada", *roles, "--password-stdin"),
        input=DECOMPOSED + "\n",
        env={"HELIOPANEL_DATA_DIR": str(tmp_path)},
    )
    assert run.exit_code == 0, run.output
    await door.keeper.refresh()
    assert hash_of(door, "ada") == FakeHasher().hash(COMPOSED)
    door.keeper.close()


@pytest.mark.parametrize("row", PASSWORDS, ids=lambda row: row["why"])
async def test_a_hash_from_before_still_works_and_is_made_anew(row: dict[str, str], office: Office) -> None:
    await as_before(office, row["text"])
    async with office.browser() as browser:
        assert (await TYPED["the page to sign in"](browser, row["text"])).status_code == 303
        assert hash_of(office) == FakeHasher().hash(prepared(row["text"]))
        answer = await TYPED["the page to sign in"](browser, row["typed"])
    assert answer.status_code == (303 if row["outcome"] == "right" else 401)


@pytest.mark.parametrize(("stored", "typed"), [(COMPOSED, DECOMPOSED), (DECOMPOSED, COMPOSED)])
async def test_a_hash_from_before_takes_the_other_form_at_once(
    stored: str, typed: str, office: Office
) -> None:
    await as_before(office, stored)
    roles = office.keeper.book.users[NAME].roles
    async with office.browser() as browser:
        assert (await TYPED["the page to sign in"](browser, typed)).status_code == 303
    assert hash_of(office) == FakeHasher().hash(COMPOSED)
    assert office.keeper.book.users[NAME].roles == roles


async def test_a_hash_from_before_of_letters_that_grow_still_works_twice(office: Office) -> None:
    text = "\N{DEVANAGARI LETTER QA}" * LONGEST
    assert len(prepared(text)) == 2 * LONGEST
    await as_before(office, text)
    async with office.browser() as browser:
        for _ in range(2):
            assert (await TYPED["the page to sign in"](browser, text)).status_code == 303


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
    "password", ["한글비밀번호열두자리요네", "مفتاح-الشمس-والريح", "солнце-якорь-гавань"]
)
def test_letters_of_other_scripts_count(password: str) -> None:
    assert weakness(password) is None


@pytest.mark.parametrize(
    ("made", "typed"), [("270441", "٢٧٠٤٤١"), ("٢٧٠٤٤١", "270441"), ("２７０４４１", "270441")]
)
async def test_a_pin_is_right_with_the_digits_of_any_keyboard(tmp_path: Path, made: str, typed: str) -> None:
    door = Door(tmp_path)
    await door.add("ada", Role.ADMINISTRATOR)
    token = await door.mint(TokenWish("gate 3", pin=made))
    who = door.who(await door.keeper.log_in_kiosk(token, "10.0.0.9", "panel"))
    with pytest.raises(WrongPassword):
        await door.keeper.step_up(who, "270442")
    await door.keeper.step_up(who, typed)
    door.keeper.close()


def test_a_real_hash_takes_both_forms() -> None:
    passwords = Passwords(Argon())
    assert passwords.matches(passwords.hash(COMPOSED), DECOMPOSED)
