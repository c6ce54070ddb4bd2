"""Why a user is not signed in."""

from datetime import timedelta

from app.base.message import say


class WrongPassword(Exception):
    """Name and password do not belong together; the text does not say which is wrong."""


class Throttled(Exception):
    """Too many wrong passwords; `wait` is how long the next try is not looked at."""

    def __init__(self, wait: timedelta) -> None:
        self.wait = wait
        seconds = max(1, round(wait.total_seconds() + 0.499))
        super().__init__(
            say("There were too many wrong passwords. Wait {seconds} s, then try again.", seconds=seconds)
        )


class TooManyAtOnce(Exception):
    """More people sign in at the same time than this computer can check."""
