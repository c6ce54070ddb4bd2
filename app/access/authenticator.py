"""The keeper of the door: knows who asks, lets people in and out, and tells when somebody must leave."""

import asyncio
import secrets
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import NoReturn, TypeVar

from sqlalchemy.exc import SQLAlchemyError

from app.access import sessions
from app.access.access_cache import Book
from app.access.accounts import Accounts, note
from app.access.events import AccessEvent, Recorded
from app.access.passwords import Passwords, prepared
from app.access.principal import Principal, SignInNeeded, Via, nobody, this_computer
from app.access.refusals import Allowance, Refusals
from app.access.roles import NOBODY, Role
from app.access.sessions import Session, digest_of, new_id
from app.access.setup import Setup
from app.access.sign_in_errors import Throttled, TooManyAtOnce, WrongPassword
from app.access.store import AccessStore, Change
from app.access.throttle import Failures, one_more, wait_left
from app.access.tickets import OneShots, csrf_token, read_stop_ticket, stop_ticket
from app.access.tokens import digest_of as token_digest
from app.access.tokens import token_id_of
from app.access.users import AccessRefused
from app.base.clock import Clock, is_within
from app.base.logs import get_logger
from app.base.message import N_, say
from app.base.permission import Permission
from app.store.store import StoreFailed

log = get_logger()
T = TypeVar("T")

LOOK_EVERY = timedelta(milliseconds=500)
MOST_WAITING = 20
LOOPBACK_ADDRESSES = frozenset({"127.0.0.1", "::1"})
WRONG_AT_ONCE, WRONG_EVERY = 200, timedelta(minutes=1)
"""How many wrong passwords are recorded one by one: at most 1,440 a day after the first 200."""

WRONG = N_("The name or the password is wrong.")


@dataclass(frozen=True, slots=True)
class Credentials:
    """What a request brings along to say who asks."""

    address: str
    session_id: str = ""
    bearer: str = ""
    ticket: str = ""
    stop_ticket: str = ""


class Keeper:
    """Judges requests by a book that is read anew, at most half a second after anything was written."""

    def __init__(self, store: AccessStore, passwords: Passwords, clock: Clock, setup: Setup) -> None:
        self.accounts = Accounts(store, passwords)
        self.setup = setup
        self.refusals = Refusals()
        self._store = store
        self._passwords = passwords
        self._clock = clock
        self._one_shots = OneShots()
        self._one_at_a_time = asyncio.Semaphore(1)
        self._waiting = 0
        self._wrong = Allowance(WRONG_AT_ONCE, WRONG_EVERY)
        self._changed = asyncio.Event()
        self.book: Book = store.load()

    @property
    def is_closed(self) -> bool:
        """Return whether only the set-up page is served: others can reach the panel, nobody may manage it."""
        return not self.setup.loopback and not self.book.has_administrator

    async def run(self) -> None:
        """Look for what the command line wrote, until cancelled."""
        while True:
            await self._clock.sleep_until(self._clock.now() + LOOK_EVERY)
            if self._store.exists():
                await self._write_refusals()
                await self.refresh()

    async def _write_refusals(self) -> None:
        noted = self.refusals.take(self._clock.now())
        due = [replace(one, at=self._clock.system_time(one.at)) for one in noted]
        if not due:
            return
        try:
            await asyncio.to_thread(self._append, due)
        except (StoreFailed, SQLAlchemyError) as error:
            log.warning("refusals could not be recorded", count=len(due), reason=str(error))

    def _append(self, events: list[AccessEvent]) -> None:
        with self._store.writing() as change:
            for event in events:
                change.note(event)

    async def refresh(self) -> None:
        """Read the book anew if anything was written, and wake who waits for changes."""
        if await asyncio.to_thread(self._store.changes) != self.book.changes:
            self._turn_to(await asyncio.to_thread(self._store.load))
        else:
            self._wake()

    def identify(self, given: Credentials) -> Principal:
        """Return who asks; a token that is wrong raises `SignInNeeded`, anything else wrong is nobody."""
        now, shown = self._clock.now(), self._clock.system_time()
        if given.bearer:
            found = self.book.by_token(given.bearer, shown, given.address)
            if found is None:
                raise SignInNeeded(N_("This token is unknown, revoked or has expired. Ask for a new one."))
            return found
        if given.ticket and (found := self._one_shots.redeem(given.ticket, now)):
            return found
        if given.session_id:
            found = self.book.by_session(digest_of(given.session_id), now, shown, given.address)
            if found is not None:
                return found
        if self.setup.loopback and not self.book.users and given.address in LOOPBACK_ADDRESSES:
            return this_computer(given.address)
        return self._by_stop_ticket(given, now)

    def _by_stop_ticket(self, given: Credentials, now: datetime) -> Principal:
        found = read_stop_ticket(self.book.key, given.stop_ticket, now) if given.stop_ticket else None
        if found is None:
            return nobody(given.address)
        allowed = NOBODY | {Permission.STOP}
        return Principal(found.name, frozenset(), allowed, Via.STOP_TICKET, given.address)

    def current(self, principal: Principal) -> Principal:
        """Return what somebody who was let in may do by now; nobody if they must leave."""
        now, shown = self._clock.now(), self._clock.system_time()
        match principal.via:
            case Via.SESSION | Via.KIOSK:
                found = self.book.by_session(principal.credential, now, shown, principal.address)
                return found or nobody(principal.address)
            case _:
                return principal if self.book.still(principal, now, shown) else nobody(principal.address)

    async def until_gone(self, principal: Principal) -> None:
        """Wait until somebody who was let in must leave."""
        while self.book.still(principal, self._clock.now(), self._clock.system_time()):
            await self._changed.wait()

    def ticket(self, principal: Principal) -> str:
        """Return a ticket that opens one stream or download within 5 s."""
        return self._one_shots.issue(principal, self._clock.now())

    def stop_ticket(self, principal: Principal) -> str:
        """Return the stop-only ticket for a page of somebody's."""
        return stop_ticket(self.book.key, principal.name, self._clock.now())

    def csrf(self, session_id: str) -> str:
        """Return what the pages of a session must send with every change."""
        return csrf_token(self.book.key, session_id)

    async def log_in(self, name: str, password: str, address: str, agent: str, held: str = "") -> str:
        """Return the id of a new session, or raise `WrongPassword`, `Throttled` or `TooManyAtOnce`.

        `held` is the session id that the browser still has from before.
        """

        def work() -> str:
            account = name.strip().lower()[:32]
            self._check(account, password, address, digest_of(held))
            return self._begin(account, "", address, agent)

        return await self.do(work)

    async def log_in_kiosk(self, token_text: str, address: str, agent: str) -> str:
        """Return the id of a new session of a cabinet's panel."""

        def work() -> str:
            now, token_id = self._clock.system_time(), token_id_of(token_text.strip()) or ""
            token = self.book.tokens.get(token_id)
            right = token is not None and token.is_kiosk and _fits(token_text.strip(), token.digest)
            if token is None or not right or now >= token.expires_at or token.is_misdated(now):
                self._fail(f"token@{address}", (f"token@{address}",), address)
            return self._begin("", token_id, address, agent)

        return await self.do(work)

    async def prove(self, principal: Principal, password: str) -> None:
        """Take the password of whoever is signed in once more; settings of weight are open for 5 minutes."""

        def work() -> None:
            session = self._session(principal)
            self._check(session.user, password, principal.address, principal.credential)
            now = self._clock.now()
            with self._store.writing() as change:
                change.put_session(replace(session, proven_at=now, used_at=now))

        await self.do(work)

    async def change_own_password(self, principal: Principal, old: str, new: str) -> None:
        """Change the password of whoever is signed in, who must know the old one."""

        def work() -> None:
            self._check(self._session(principal).user, old, principal.address, principal.credential)
            now = self._clock.system_time()
            self.accounts.set_password(principal, principal.name, new, now, keep=principal.credential)

        await self.do(work)

    def own_sessions(self, principal: Principal) -> tuple[Session, ...]:
        """Return the sessions of whoever is signed in, the newest first; a program has none."""
        if principal.via is not Via.SESSION:
            return ()
        return tuple(one for one in self.sessions() if one.user == principal.name)

    def sessions(self) -> tuple[Session, ...]:
        """Return all sessions, the newest first, with the instants that the system's clock shows for them."""
        found = sorted(self.book.sessions.values(), key=lambda one: one.began_at, reverse=True)
        told = self._clock.system_time
        return tuple(replace(one, began_at=told(one.began_at), used_at=told(one.used_at)) for one in found)

    async def end_own_session(self, principal: Principal, digest: str) -> None:
        """End a session of whoever is signed in; one that is not theirs stays."""
        session = self.book.sessions.get(digest)
        if session is not None and session.user == principal.name and principal.via is Via.SESSION:
            await self.do(lambda: self.accounts.end_session(principal, digest, self._clock.system_time()))

    async def step_up(self, principal: Principal, pin: str) -> None:
        """Let a cabinet's panel operate for 5 minutes."""

        def work() -> None:
            session = self._session(principal)
            token = self.book.tokens.get(session.token_id)
            if token is None:
                raise AccessRefused(
                    N_("A PIN works only on a cabinet display; sign in with a name and password.")
                )
            subject = (f"pin:{token.token_id}",)
            self._wait(subject, principal)
            if not self._passwords.matches_pin(token.pin_hash, pin):
                self._fail(say("PIN of {name}", name=token.name), subject, principal.address)
            until = self._clock.now() + sessions.STEP_UP
            with self._store.writing() as change:
                change.forgive(subject)
                change.put_session(replace(session, stepped_until=until))
                note(change, principal, "stepped_up", token.name, self._clock.system_time())

        await self.do(work)

    async def set_up(self, code: str, name: str, password: str, address: str) -> None:
        """Make the first administrator with the one-time code, which is then worth nothing."""

        def work() -> None:
            now, subject = self._clock.system_time(), (f"setup@{address}",)
            self._wait(subject, nobody(address))
            if not self.setup.accepts(code):
                self._fail(N_("setup code"), subject, address)
            self.accounts.add(nobody(address), name, {Role.ADMINISTRATOR}, password, now)
            self.setup.used()

        await self.do(work)

    async def log_out(self, principal: Principal) -> None:
        """End the session of whoever asks."""
        if principal.via in (Via.SESSION, Via.KIOSK):
            await self.do(
                lambda: self.accounts.end_session(principal, principal.credential, self._clock.system_time())
            )

    async def used(self, principal: Principal) -> None:
        """Remember that somebody was active, at most once a minute; who rests must prove who it is first."""
        session = self.book.sessions.get(principal.credential)
        if session is None or principal.rests or principal.via is not Via.SESSION:
            return
        now = self._clock.now()
        if is_within(session.used_at, now, sessions.USE_WRITTEN_EVERY):
            return

        def work() -> None:
            with self._store.writing() as change:
                change.put_session(replace(session, used_at=now))

        await self.do(work)

    async def do(self, work: Callable[[], T]) -> T:
        """Do something slow in a thread, one after the other, and judge by its result from now on."""
        if self._waiting >= MOST_WAITING:
            raise TooManyAtOnce(N_("Many users are signing in now. Wait a few seconds, then try again."))
        self._waiting += 1
        try:
            async with self._one_at_a_time:
                try:
                    return await asyncio.to_thread(work)
                finally:
                    await self.refresh()
        finally:
            self._waiting -= 1

    async def events(self, before: int | None, limit: int) -> list[Recorded]:
        """Return what happened to users, sessions, tokens and the network, newest first."""
        return await asyncio.to_thread(self._store.newest_events, before, limit)

    def close(self) -> None:
        """Close the database."""
        self._store.close()

    def _check(self, account: str, password: str, address: str, held: str) -> None:
        """Raise unless the password is right.

        Mistakes count for the account at this address, the address, and the account; those of a browser that
        holds a session of the account (its digest is `held`) for that browser alone. A first try from an
        address is always looked at: so guesses from elsewhere lock nobody out. Whether there is such an
        account changes nothing here, so that nobody learns it.
        """
        knows = self._knows(account, held)
        here = f"{account}@{held if knows else address}"[:120]
        elsewhere = (f"address:{address}"[:120], f"account:{account}"[:120])
        subjects = (here,) if knows else (here, *elsewhere)
        self._wait(subjects, nobody(address), first=here)
        user = self.book.users.get(account)
        form = self._passwords.matching(user.password_hash if user else None, password)
        if user is None or form is None:
            self._fail(account, subjects, address)
        renewed = "" if form == prepared(password) else self._passwords.hash_again(password)
        with self._store.writing() as change:
            change.forgive((here,))
            stored = change.users().get(account) if renewed else None
            if stored is not None and stored.password_hash == user.password_hash:
                change.put_user(replace(stored, password_hash=renewed))

    def _wait(self, subjects: tuple[str, ...], who: Principal, *, first: str = "") -> None:
        found = self._store.failures(subjects)
        judged = [one for name, one in found.items() if first in found or not name.startswith("account:")]
        wait = wait_left(judged, self._clock.now())
        if wait > timedelta():
            throttled = Throttled(wait)
            self.refusals.note(
                "refused_log_in", who, subjects[0].partition("@")[0], str(throttled), self._clock.now()
            )
            raise throttled

    def _fail(self, account: str, subjects: tuple[str, ...], address: str) -> NoReturn:
        now = self._clock.now()
        with self._store.writing() as change:
            before: dict[str, Failures] = change.failures(subjects)
            for subject in subjects:
                change.put_failures(subject, one_more(before.get(subject), now))
            if self._wrong.take(now):
                note(change, nobody(address), "log_in", account, self._clock.system_time(now), "wrong")
            else:
                self.refusals.leave_out()
        log.warning("a password was wrong", account=account, address=address)
        raise WrongPassword(WRONG)

    def _begin(self, user: str, token_id: str, address: str, agent: str) -> str:
        now, session_id = self._clock.now(), new_id()
        session = Session(
            digest_of(session_id), user, token_id, address[:64], agent[: sessions.AGENT_KEPT], now, now, now
        )
        with self._store.writing() as change:
            change.end_old_sessions(now - sessions.ABSOLUTE)
            change.put_session(session)
            _greet(change, user or self.book.tokens[token_id].name, address, self._clock.system_time(now))
        return session_id

    def _session(self, principal: Principal) -> Session:
        session = self.book.sessions.get(principal.credential)
        if session is None:
            raise SignInNeeded(N_("This session has ended. Sign in again."))
        return session

    def _knows(self, account: str, held: str) -> bool:
        """Return whether this is the digest of a session of this account, begun within the last 12 hours."""
        session = self.book.sessions.get(held)
        return session is not None and session.user == account != ""

    def _turn_to(self, book: Book) -> None:
        self.book = book
        self._wake()

    def _wake(self) -> None:
        self._changed.set()
        self._changed = asyncio.Event()


def new_key() -> bytes:
    """Return a new secret for tickets."""
    return secrets.token_bytes(32)


def _fits(text: str, digest: str) -> bool:
    return secrets.compare_digest(token_digest(text), digest)


def _greet(change: Change, name: str, address: str, now: datetime) -> None:
    by = replace(nobody(address), name=name, via=Via.SESSION)
    note(change, by, "log_in", name, now)
