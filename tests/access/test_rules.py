"""The rules of access, without a panel."""

from datetime import UTC, datetime, timedelta

import pytest

from app.access.authenticator import new_key
from app.access.passwords import Argon, Passwords, weakness
from app.access.roles import GRANTS, Role
from app.access.sessions import Session, SessionState, is_proven, new_id, state
from app.access.sign_in_errors import Throttled
from app.access.throttle import Failures, delay, one_more, wait_left
from app.access.tokens import SCOPES, mint, token_id_of
from app.access.users import AccessRefused
from app.base.permission import Permission
from tests.access.fake_hasher import FakeHasher

NOW = datetime(2026, 11, 21, 12, tzinfo=UTC)


@pytest.mark.parametrize("role", Role)
def test_every_role_sees_and_stops_and_only_an_administrator_manages_users(role: Role) -> None:
    assert {Permission.READ, Permission.STOP} <= GRANTS[role]
    assert (Permission.ADMINISTER in GRANTS[role]) == (role is Role.ADMINISTRATOR)
    assert (Permission.OPERATE in GRANTS[role]) == (role in {Role.OPERATOR, Role.ENGINEER})


def test_no_scope_reaches_users() -> None:
    assert all(Permission.ADMINISTER not in granted for granted in SCOPES.values())


def test_the_delay_grows_to_thirty_seconds_and_no_further() -> None:
    waits = [delay(Failures(count, NOW)).total_seconds() for count in (1, 2, 3, 4, 5, 8, 1000)]
    assert waits == [0, 0, 1, 2, 4, 30, 30]


def test_a_clock_that_is_set_back_makes_nobody_wait() -> None:
    assert wait_left([Failures(50, NOW)], NOW - timedelta(days=3)) == timedelta()
    assert one_more(Failures(9, NOW), NOW - timedelta(days=3)) == Failures(10, NOW - timedelta(days=3))


def test_mistakes_of_yesterday_are_forgotten() -> None:
    assert one_more(Failures(9, NOW), NOW + timedelta(hours=25)).count == 1
    assert one_more(Failures(9, NOW), NOW + timedelta(hours=24)).count == 10
    assert one_more(Failures(9, NOW), NOW + timedelta(hours=1)).count == 10


def test_a_session_rests_after_thirty_minutes_and_ends_after_twelve_hours() -> None:
    session = Session("d", "anna", "", "127.0.0.1", "", NOW, NOW, NOW)
    assert state(session, NOW + timedelta(minutes=29)) is SessionState.LIVE
    assert state(session, NOW + timedelta(minutes=30)) is SessionState.IDLE
    assert state(session, NOW + timedelta(hours=12)) is SessionState.ENDED


def test_a_token_with_one_wrong_letter_is_none() -> None:
    token_id, text = mint()
    assert token_id_of(text) == token_id
    assert text.startswith("hp_")
    for place in (3, 20, len(text) - 1):
        changed = "A" if text[place] != "A" else "B"
        assert token_id_of(text[:place] + changed + text[place + 1 :]) is None
    assert token_id_of("hp_" + "é" * 46) is None


@pytest.mark.parametrize(
    "password",
    [
        "short",
        "x" * 129,
        "aaaaaaaaaaaa",
        "abcabcabcabc",
        "123456789012",
        "qwertyuiopas",
        "xqzxqzxqzxqz",
        "fdsapoiuytre",
        "Heliopanel2026!",
        "S0larTr4cker99",
        "passwordpassword",
        "anna.k2026anna.k",
    ],
)
def test_passwords_that_people_guess_are_refused(password: str) -> None:
    assert weakness(password, "anna.k")


@pytest.mark.parametrize(
    "password",
    [
        "violet-anvil-harbour-9",
        "z9" + "qk7" * 42,
        "plum-9-kites",
        "ğüşiöç ve üç ördek",
        "lower case is fine too",
        "z9" + "qk7" * 40,
    ],
)
def test_other_passwords_are_taken_whatever_they_are_made_of(password: str) -> None:
    assert weakness(password, "anna") is None


@pytest.mark.parametrize("pin", ["12345", "111222", "123456", "12345a", "1234567890123"])
def test_simple_pins_are_refused(pin: str) -> None:
    with pytest.raises(AccessRefused, match="PIN"):
        Passwords(FakeHasher()).hash_pin(pin)


@pytest.mark.parametrize("pin", ["112233", "270441", "270441270441"])
def test_a_pin_of_three_different_digits_is_taken(pin: str) -> None:
    passwords = Passwords(FakeHasher())
    assert passwords.matches(passwords.hash_pin(pin), pin)


def test_argon2id_is_used_with_the_decided_cost() -> None:
    argon = Argon()
    stored = argon.hash("violet-anvil-harbour-9")
    assert stored.startswith("$argon2id$v=19$m=65536,t=3,p=1$")
    assert argon.verify(stored, "violet-anvil-harbour-9")
    assert not argon.verify(stored, "violet-anvil-harbour-8")
    assert not argon.verify("no hash", "violet-anvil-harbour-9")


class Recorder(FakeHasher):
    """Notes against what was checked."""

    def __init__(self) -> None:
        super().__init__()
        self.looked_at: list[tuple[str, str]] = []

    def verify(self, password_hash: str, password: str) -> bool:
        self.looked_at.append((password_hash, password))
        return super().verify(password_hash, password)


def test_an_unknown_name_is_checked_against_a_hash_that_is_made_once() -> None:
    hasher = Recorder()
    passwords = Passwords(hasher)
    passwords.warm()
    passwords.warm()
    assert hasher.made == 1
    assert not passwords.matches(None, "wrong")
    ((against, _),) = hasher.looked_at
    assert against.startswith("fake$")
    stored = passwords.hash("violet-anvil-harbour-9")
    assert passwords.matches(stored, "violet-anvil-harbour-9")
    assert hasher.looked_at[-1][0] == stored


def test_of_a_password_without_end_so_much_is_hashed_that_it_is_wrong() -> None:
    hasher = Recorder()
    passwords = Passwords(hasher)
    longest = "z9" + "qk7" * 42
    assert len(longest) == 128
    stored = passwords.hash(longest)
    assert passwords.matches(stored, longest)
    assert not passwords.matches(stored, longest + "x")
    passwords.matches(stored, "x" * 10_000)
    assert len(hasher.looked_at[-1][1]) == 129


def test_ids_and_keys_are_256_random_bits() -> None:
    assert len(new_key()) == 32
    assert len({new_id() for _ in range(100)}) == 100
    assert {len(new_id()) for _ in range(100)} == {43}


def test_who_never_typed_a_password_has_not_proven_anything() -> None:
    assert not is_proven(None, NOW)
    assert is_proven(NOW, NOW + timedelta(minutes=4, seconds=59))


@pytest.mark.parametrize(
    ("wait_s", "told"), [(0.01, 1), (0.5, 1), (1.0, 1), (1.2, 2), (29.6, 30), (30.0, 30)]
)
def test_a_wait_is_told_in_whole_seconds_never_too_short(wait_s: float, told: int) -> None:
    assert f"Wait {told} s," in str(Throttled(timedelta(seconds=wait_s)))
