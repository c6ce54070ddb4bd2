"""Passwords: which are refused, and how they are kept (argon2id, RFC 9106)."""

import hashlib
import re
from functools import cache
from importlib.resources import files
from typing import Protocol
from unicodedata import category, decimal, normalize

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError, VerifyMismatchError

from app.access.users import AccessRefused
from app.base.message import N_, say

SHORTEST, LONGEST = 12, 128
TIME_COST, MEMORY_KIB, LANES = 3, 64 * 1024, 1
PIN = re.compile(r"\d{6,12}")
NO_LETTER = re.compile(r"[\W\d_]")
LOOKALIKES = str.maketrans("013457@$!", "oieastasi")
ROWS = (
    "01234567890123456789",
    "abcdefghijklmnopqrstuvwxyz",
    "qwertyuiopasdfghjklzxcvbnm",
    "qwertzuiopasdfghjklyxcvbnm",
)


class Hasher(Protocol):
    """Makes and checks slow hashes; a fake one counts its calls in tests."""

    def hash(self, password: str) -> str:
        """Return a salted hash."""

    def verify(self, password_hash: str, password: str) -> bool:
        """Return whether a password belongs to a hash."""


class Argon:
    """argon2id with t=3, m=64 MiB, p=1: about 0.1 s and 64 MiB for each guess."""

    def __init__(self) -> None:
        self._hasher = PasswordHasher(time_cost=TIME_COST, memory_cost=MEMORY_KIB, parallelism=LANES)

    def hash(self, password: str) -> str:
        """Return a salted hash that names its own parameters."""
        return self._hasher.hash(password)

    def verify(self, password_hash: str, password: str) -> bool:
        """Return whether a password belongs to a hash; a hash that cannot be read belongs to none."""
        try:
            return self._hasher.verify(password_hash, password)
        except (VerifyMismatchError, VerificationError, InvalidHashError):
            return False


class Passwords:
    """Checks passwords so that an unknown name takes exactly the work of a known one."""

    def __init__(self, hasher: Hasher) -> None:
        self._hasher = hasher
        self._nobodys: str | None = None

    def warm(self) -> None:
        """Make the hash that unknown names are checked against, so that the first guess takes no longer."""
        if self._nobodys is None:
            self._nobodys = self._hasher.hash(hashlib.sha256(b"nobody").hexdigest())

    def hash(self, password: str, name: str = "") -> str:
        """Return the hash of a password, or raise `AccessRefused` if people would guess it."""
        if fault := weakness(prepared(password), name):
            raise AccessRefused(fault)
        return self.hash_again(password)

    def hash_again(self, password: str) -> str:
        """Return the hash of a password that was right under another one, of as much as is compared."""
        return self._hasher.hash(prepared(password)[: LONGEST + 1])

    def hash_pin(self, pin: str) -> str:
        """Return the hash of a cabinet panel's PIN, or raise `AccessRefused`."""
        pin = in_digits(pin)
        if not PIN.fullmatch(pin) or len(set(pin)) < 3 or pin in ROWS[0]:
            raise AccessRefused(
                N_("A PIN has 6 to 12 digits, with at least three different digits and no simple sequence.")
            )
        return self._hasher.hash(pin)

    def matches(self, password_hash: str | None, password: str) -> bool:
        """Return whether a password is right; without a hash the same work is done and it is wrong."""
        return self.matching(password_hash, password) is not None

    def matching(self, password_hash: str | None, password: str) -> str | None:
        """Return the form of a password that its hash was made of, None where it is wrong.

        Hashes made before passwords were prepared are of what was typed, on one keyboard or another.
        """
        self.warm()
        plain = prepared(password)
        forms = dict.fromkeys((plain, password, normalize("NFD", password)))
        stored = password_hash or self._nobodys or ""
        found = next((form for form in forms if self._hasher.verify(stored, form[: LONGEST + 1])), None)
        return None if password_hash is None else found

    def matches_pin(self, pin_hash: str, pin: str) -> bool:
        """Return whether a PIN is right, with the digits of any keyboard."""
        return any(self.matches(pin_hash, form) for form in dict.fromkeys((in_digits(pin), pin)))


def prepared(password: str) -> str:
    """Return a password as it is hashed, however keyboards compose its letters (RFC 8265, OpaqueString)."""
    spaced = "".join(" " if category(letter) == "Zs" else letter for letter in password)
    return normalize("NFC", spaced)


def in_digits(pin: str) -> str:
    """Return a PIN with the digits 0 to 9."""
    return "".join(letter if decimal(letter, None) is None else str(decimal(letter)) for letter in pin)


def weakness(password: str, name: str = "") -> str | None:
    """Return why a password is refused, None if it is good enough. Nothing is said of kinds of characters."""
    if not SHORTEST <= len(password) <= LONGEST:
        return say(
            "A password has {shortest} to {longest} characters; four unrelated words work well.",
            shortest=SHORTEST,
            longest=LONGEST,
        )
    plain = password.lower()
    if _repeats(plain) or _is_row(plain) or _is_common(plain, name.lower()):
        return N_(
            "This password is easy to guess: it uses common words, a name, or a keyboard "
            "sequence. Choose another."
        )
    return None


def _repeats(text: str) -> bool:
    """Return whether a text is one short block again and again."""
    return any(text == (text[:size] * len(text))[: len(text)] for size in range(1, 5))


def _is_row(text: str) -> bool:
    """Return whether a text goes along the keys, the alphabet or the digits, either way."""
    return any(text in row + row or text[::-1] in row + row for row in ROWS)


def _is_common(text: str, name: str) -> bool:
    """Return whether nothing is left of a text but common words, the user's name, digits and signs."""
    words = common_words() | ({NO_LETTER.sub("", name)} - {""})
    return any(_made_of(NO_LETTER.sub("", shape), words) for shape in (text, text.translate(LOOKALIKES)))


def _made_of(text: str, words: frozenset[str] | set[str]) -> bool:
    reached = {0}
    for end in range(1, len(text) + 1):
        if any(start in reached and text[start:end] in words for start in range(end)):
            reached.add(end)
    return len(text) in reached


@cache
def common_words() -> frozenset[str]:
    """Return the words of `common.txt`."""
    lines = (files("app.access") / "common.txt").read_text(encoding="utf-8").splitlines()
    return frozenset(line for line in lines if line and not line.startswith("#"))
