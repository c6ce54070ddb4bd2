"""How much one client may ask for: so many requests a second, and some at once."""

from datetime import timedelta

from app.base.clock import Clock


class Budget:
    """Allows `burst` requests at once and `per_s` a second on average; what is saved up is never more."""

    def __init__(self, clock: Clock, *, per_s: float, burst: int) -> None:
        self._clock = clock
        self._each = timedelta(seconds=1.0 / per_s)
        self._saved = (burst - 1) * self._each
        self._paid_until = clock.now() - self._saved

    def spend(self) -> bool:
        """Return whether one more request is allowed now, and count it if it is."""
        now = self._clock.now()
        begin = max(self._paid_until, now - self._saved)
        if begin > now:
            return False
        self._paid_until = begin + self._each
        return True

    async def wait(self) -> None:
        """Return once one more request is allowed; it is counted."""
        while not self.spend():
            await self._clock.sleep_until(self._paid_until)
