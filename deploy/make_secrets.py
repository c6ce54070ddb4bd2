"""Makes the passwords of compose.yaml at random, in the folder `secrets` beside this file or in another.

Another user of the broker: `python3 deploy/make_secrets.py --broker-user NAME` prints a password and adds it.
"""

import argparse
import hashlib
import os
import secrets
from base64 import b64encode
from pathlib import Path

ROUNDS = 101
"""Mosquitto's own number; a password of 192 random bits needs no more."""
SETTINGS = """# Settings of Heliopanel in its container; see docs, Settings.
database_url = "postgresql+psycopg://heliopanel:{database}@database/heliopanel"
mqtt_password = "{broker}"
"""


def broker_line(user: str, password: str) -> str:
    """Return a line of Mosquitto's password file."""
    salt = secrets.token_bytes(12)
    found = hashlib.pbkdf2_hmac("sha512", password.encode(), salt, ROUNDS)
    return f"{user}:$7${ROUNDS}${b64encode(salt).decode()}${b64encode(found).decode()}\n"


def put(path: Path, text: str) -> None:
    """Write a file that the folder keeps from others here; in its container another user must read it."""
    unfinished = path.with_suffix(".unfinished")
    unfinished.write_text(text)
    unfinished.chmod(0o444)
    os.replace(unfinished, path)


def make(folder: Path) -> None:
    """Make all of them, or none where there are some: a database keeps its first password."""
    if any(folder.glob("*")):
        raise SystemExit(
            f"{folder} is not empty. Remove it only together with the volumes that know its passwords."
        )
    folder.mkdir(mode=0o700, exist_ok=True)
    folder.chmod(0o700)
    database, broker = secrets.token_urlsafe(24), secrets.token_urlsafe(24)
    put(folder / "database_password", database)
    put(folder / "broker_passwords", broker_line("heliopanel", broker))
    put(folder / "settings.toml", SETTINGS.format(database=database, broker=broker))
    print(f"The passwords are in {folder}.")  # noqa: T201


def add_user(folder: Path, user: str) -> None:
    """Give another program a user at the broker."""
    path, password = folder / "broker_passwords", secrets.token_urlsafe(24)
    lines = path.read_text().splitlines(keepends=True)
    if ":" in user or any(line.startswith(f"{user}:") for line in lines):
        raise SystemExit(f"{user} is there already, or no name. Choose another.")
    put(path, "".join(lines) + broker_line(user, password))
    print(f"The password of {user} is {password}. Start the broker again.")  # noqa: T201


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", type=Path, default=Path(__file__).with_name("secrets"))
    parser.add_argument("--broker-user", metavar="NAME")
    given = parser.parse_args()
    add_user(given.folder, given.broker_user) if given.broker_user else make(given.folder)
