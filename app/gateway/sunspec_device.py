"""The SunSpec map behind a Modbus server: reads from the newest snapshot, writes into orders."""

from collections.abc import Sequence
from datetime import datetime, timedelta
from ipaddress import ip_address, ip_network

from app.base.clock import Clock
from app.base.logs import get_logger
from app.base.message import say
from app.gateway.ports import Door, refused
from app.gateway.sunspec_controls import ACTOR, BUSY, Controls
from app.gateway.sunspec_map import BASE, END, MARKER, Block, Placed, SunSpecMap, sunspec_map
from app.gateway.sunspec_values import UNKNOWN_TYPE, View, block_words, tracker_type
from app.modbus.server import ILLEGAL_ADDRESS, ILLEGAL_FUNCTION, ILLEGAL_VALUE, Refusal, answer
from app.tracker.state.snapshot import EventKind

FAILURE = 4
SERIAL = "serial"
"""Who asks over a serial line, which has no addresses."""
WRITING = {5, 6, 15, 16, 23}
READ_WRITE = 23
SETTING = "HELIOPANEL_SUNSPEC_WRITE_HOSTS"
TELL_AGAIN = timedelta(minutes=1)
MOST_HOSTS = 256
SETTING_UP = {EventKind.TRACKER_ADDED, EventKind.TRACKER_CHANGED, EventKind.TRACKER_REMOVED}
FOLLOW_AGAIN = timedelta(seconds=1)

log = get_logger()

Write = tuple[Block, dict[str, float | None]]


class SunSpecDevice:
    """Answers SunSpec requests; hosts that are not in `write_hosts` may only read."""

    def __init__(self, door: Door, clock: Clock, *, unit: int = 1, write_hosts: Sequence[str] = ()) -> None:
        self.controls = Controls(door)
        self._door = door
        self._clock = clock
        self._unit = unit
        self._write_hosts = tuple(write_hosts)
        self._map = sunspec_map((), weather=False)
        self._had_weather = False
        self._type = UNKNOWN_TYPE
        self._written: list[Write] = []
        self._turned_away: dict[str, tuple[datetime, int]] = {}

    async def respond(self, request: bytes, host: str) -> bytes:
        """Return the reply to one request; a write is answered when its orders were carried out."""
        try:
            if request[0] in WRITING and not self.may_write(host):
                self._turn_away(host)
                raise Refusal(ILLEGAL_FUNCTION)
            self._written = []
            reply, orders = answer(self, request), self._written
            if reply[0] & 0x80 or not orders:
                return reply
            await self._carry_out(orders, host)
        except Refusal as refusal:
            return bytes((request[0] | 0x80, refusal.code))
        if request[0] == READ_WRITE:
            return bytes((READ_WRITE,)) + answer(self, bytes((3,)) + request[1:5])[1:]
        return reply

    def may_write(self, host: str) -> bool:
        """Return whether a host is allowed to write."""
        if host == SERIAL:
            return SERIAL in self._write_hosts
        networks = (ip_network(one, strict=False) for one in self._write_hosts if one != SERIAL)
        return any(ip_address(host.partition("%")[0]) in network for network in networks)

    async def follow(self) -> None:
        """Follow what happens on the site, until cancelled."""
        while True:
            self._type = await self._tracker_type()
            async for update in self._door.updates():
                if any(event.kind in SETTING_UP for event in update.events):
                    self._type = await self._tracker_type()
                await self.controls.follow(update)
            await self._clock.sleep_until(self._clock.now() + FOLLOW_AGAIN)

    async def _tracker_type(self) -> int:
        """Return the type that the mounts of the trackers make, which snapshots do not tell."""
        detail = await self._door.detail()
        return tracker_type(one.state.config.mount.kind for one in detail.trackers.values())

    def read_bits(self, function: int, address: int, count: int) -> list[bool]:
        """Refuse: the map has no bits."""
        raise Refusal(ILLEGAL_ADDRESS)

    def write_bits(self, address: int, values: Sequence[bool]) -> None:
        """Refuse: the map has no bits."""
        raise Refusal(ILLEGAL_ADDRESS)

    def read_registers(self, function: int, address: int, count: int) -> Sequence[int]:
        """Return what a span of the map tells now."""
        found, view = self.map(), self._view()
        if not (address >= BASE and address + count <= found.end):
            raise Refusal(ILLEGAL_ADDRESS)
        if view is None:
            raise Refusal(BUSY)
        blocks = found.spanned(address, count)
        words = [word for block in blocks for word in block_words(view, block)]
        start = blocks[0].address if blocks else found.end - len(END)
        if address < BASE + len(MARKER):
            words, start = [*MARKER, *words], BASE
        words.extend(END)
        return words[address - start : address - start + count]

    def write_registers(self, address: int, words: Sequence[int]) -> None:
        """Take whole writable points; they are carried out by `respond`."""
        blocks = self.map().spanned(address, len(words))
        touched = [
            (block, placed)
            for block in blocks
            for placed in block.points
            if placed.address < address + len(words) and placed.end > address
        ]
        if not touched or not all(placed.point.writable for _, placed in touched):
            raise Refusal(ILLEGAL_ADDRESS)
        if touched[0][1].address != address or touched[-1][1].end != address + len(words):
            raise Refusal(ILLEGAL_VALUE)
        self._written.append((touched[0][0], _values([placed for _, placed in touched], address, words)))

    async def let_out(self, reply: bytes) -> bytes | None:
        """Return the reply as it is."""
        return reply

    def map(self) -> SunSpecMap:
        """Return the map of the trackers that the site has now; model 307 comes with the first weather."""
        site = self._door.latest()
        if site is not None:
            self._had_weather = self._had_weather or site.weather is not None
            tracker_ids = tuple(one.tracker_id for one in site.trackers)
            grown = len(self._map.blocks) != 3 + len(tracker_ids) + self._had_weather
            if grown or tracker_ids != self._map.tracker_ids:
                self._map = sunspec_map(tracker_ids, weather=self._had_weather)
        return self._map

    def _view(self) -> View | None:
        site = self._door.latest()
        if site is None:
            return None
        return View(site, self._unit, self.controls.targets, self.controls.calibrations.trackers, self._type)

    async def _carry_out(self, orders: Sequence[Write], host: str) -> None:
        for block, values in orders:
            try:
                await self.controls.write(block.tracker_id, values, f"{ACTOR}{host}")
            except Refusal:
                raise
            except Exception as error:
                log.exception("sunspec_write_failed", host=host)
                raise Refusal(FAILURE) from error

    def _turn_away(self, host: str) -> None:
        """Journal that a host tried to write: at once, then at most once a minute with how often."""
        now = self._clock.now()
        told_at, count = self._turned_away.get(host, (None, 0))
        count += 1
        if told_at is None or now - told_at >= TELL_AGAIN:
            message = (
                say(
                    "{host} tried to write over SunSpec, but only the hosts in {setting} may.",
                    host=host,
                    setting=SETTING,
                )
                if count == 1
                else say(
                    "{host} tried {count} times to write over SunSpec, but only the hosts in {setting} may.",
                    host=host,
                    count=count,
                    setting=SETTING,
                )
            )
            refused(self._door, None, f"{ACTOR}{host}", message)
            told_at, count = now, 0
        if host in self._turned_away or len(self._turned_away) < MOST_HOSTS:
            self._turned_away[host] = (told_at, count)


def _values(points: Sequence[Placed], address: int, words: Sequence[int]) -> dict[str, float | None]:
    return {
        placed.point.name: placed.point.value(tuple(words[placed.address - address : placed.end - address]))
        for placed in points
    }
