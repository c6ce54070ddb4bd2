"""What the templates about access are given."""

from dataclasses import dataclass
from datetime import datetime
from typing import ClassVar

from app.access.sessions import Session
from app.access.tokens import Token
from app.access.users import User
from app.web.shell.contexts import Form, Frame


@dataclass(frozen=True, slots=True)
class SignInPage:
    """The form to sign in, to type the password again, to set up, or to bind a cabinet's panel.

    `made` is the name of the first administrator, whom this browser has just made.
    """

    template: ClassVar[str] = "sign_in.html"

    frame: Frame
    purpose: str
    form: Form
    back: str
    problem: str
    notice: str
    made: str


@dataclass(frozen=True, slots=True)
class AccountPage:
    """Who is signed in, with what they can change about themselves."""

    template: ClassVar[str] = "account.html"

    frame: Frame
    form: Form
    problem: str
    done: str
    sessions: tuple[Session, ...]
    mine: str
    now: datetime


@dataclass(frozen=True, slots=True)
class UsersPage:
    """All users and sessions, and the form for a new user."""

    template: ClassVar[str] = "users.html"

    frame: Frame
    users: tuple[User, ...]
    sessions: tuple[Session, ...]
    form: Form
    chosen: frozenset[str]
    problem: str
    done: str
    mine: str


@dataclass(frozen=True, slots=True)
class TokensPage:
    """All tokens, the form for a new one, and the new one itself, once."""

    template: ClassVar[str] = "tokens.html"

    frame: Frame
    tokens: tuple[Token, ...]
    form: Form
    chosen: frozenset[str]
    problem: str
    made: str
    now: datetime
