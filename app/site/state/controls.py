"""Who has control of which tracker, kept by the site."""

import asyncio

from app.site.state.authority import Authority


class Controls:
    """The authority over every tracker, and the lock under which it changes."""

    def __init__(self) -> None:
        self._authorities: dict[str, Authority] = {}
        self._locks: dict[str, asyncio.Lock] = {}

    def of(self, tracker_id: str, stored_epoch: int) -> Authority:
        """Return the authority over a tracker."""
        return self._authorities.setdefault(tracker_id, Authority(stored_epoch + 1))

    @property
    def held(self) -> tuple[str, ...]:
        """Return the trackers that somebody has control of, or wants: time changes nothing about others."""
        found = self._authorities.items()
        return tuple(name for name, one in found if one.lease is not None or one.wish is not None)

    def put(self, tracker_id: str, authority: Authority) -> None:
        """Let this be the authority over a tracker from now on."""
        self._authorities[tracker_id] = authority

    def lock(self, tracker_id: str) -> asyncio.Lock:
        """Return the lock under which the authority over a tracker changes."""
        return self._locks.setdefault(tracker_id, asyncio.Lock())
