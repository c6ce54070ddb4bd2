"""Opens access when the panel starts: resets it where a file asks for that, offers the one-time code."""

import sys

from sqlalchemy.exc import SQLAlchemyError

from app.access.accounts import Accounts
from app.access.authenticator import Keeper, new_key
from app.access.passwords import Argon, Hasher, Passwords
from app.access.principal import nobody
from app.access.setup import CODE_FILE, Setup
from app.access.store import AccessStore
from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import N_
from app.base.settings import Settings
from app.store.store import StoreFailed

log = get_logger()


def open_store(settings: Settings) -> AccessStore:
    """Return the store of users that these settings name; nothing is written yet."""
    return AccessStore(settings.access_url, new_key())


def open_keeper(settings: Settings, clock: Clock, hasher: Hasher | None = None) -> Keeper:
    """Return the keeper of the panel's door."""
    store, passwords = open_store(settings), Passwords(hasher or Argon())
    setup = Setup(settings.data_dir, settings.is_loopback)
    if setup.reset_wanted():
        Accounts(store, passwords).factory_reset(nobody(N_("data folder")), clock.system_time())
        log.warning("access was reset: all users, sessions and tokens are removed")
    _end_future(store, clock)
    keeper = Keeper(store, passwords, clock, setup)
    if keeper.is_closed:
        _announce(setup.offer(), settings)
    return keeper


def _end_future(store: AccessStore, clock: Clock) -> None:
    try:
        store.end_future(clock.now())
    except (StoreFailed, SQLAlchemyError) as error:
        log.warning("what is dated in the future could not be ended in the store", reason=str(error))


def _announce(code: str, settings: Settings) -> None:
    where = settings.data_dir / CODE_FILE
    sys.stderr.write(
        f"Heliopanel has no administrator yet. Open the panel and give this one-time code: {code}\n"
        f"It is also in {where}. Or run: heliopanel users add NAME --role administrator\n"
    )
    log.warning("the panel serves only its set-up page until there is an administrator", code_file=str(where))
