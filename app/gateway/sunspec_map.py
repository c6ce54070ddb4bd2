"""Where every point lies: computed from the models' tables for the trackers that a site has."""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from app.gateway.sunspec_points import COMMON, LOCATION, TRACKERS, WEATHER, Model, Point, PointType

BASE = 40000
MARKER = (0x5375, 0x6E53)
"""The letters SunS, by which a SunSpec map is found."""
END = (0xFFFF, 0)
ID = Point("ID", PointType.UINT16, text="model")
LENGTH = Point("L", PointType.UINT16, text="length of the model")


@dataclass(frozen=True, slots=True)
class Placed:
    """A point and the address of its first word."""

    point: Point
    address: int

    @property
    def end(self) -> int:
        """Return the address behind its last word."""
        return self.address + self.point.size


@dataclass(frozen=True, slots=True)
class Block:
    """Points in a row: the fixed part of a model, or the part of one tracker (`tracker_id`)."""

    model: Model
    points: tuple[Placed, ...]
    length: int
    tracker_id: str | None = None

    @property
    def address(self) -> int:
        """Return the address of the first word."""
        return self.points[0].address

    @property
    def end(self) -> int:
        """Return the address behind the last word."""
        return self.points[-1].end


@dataclass(frozen=True, slots=True)
class SunSpecMap:
    """All blocks without a gap from behind the marker to the end model."""

    tracker_ids: tuple[str, ...]
    blocks: tuple[Block, ...]

    @property
    def end(self) -> int:
        """Return the address behind the end model."""
        return self.blocks[-1].end + len(END)

    def spanned(self, address: int, count: int) -> Sequence[Block]:
        """Return the blocks that a span of addresses touches."""
        first = bisect_right(self.blocks, address, key=lambda block: block.end)
        last = bisect_right(self.blocks, address + count - 1, key=lambda block: block.address)
        return self.blocks[first:last]

    def placed(self) -> Iterator[tuple[Block, Placed]]:
        """Yield every point with its block, in the order of addresses."""
        for block in self.blocks:
            for placed in block.points:
                yield block, placed


def sunspec_map(tracker_ids: Sequence[str], *, weather: bool) -> SunSpecMap:
    """Return the map of a site: models 1, 601, 305, and 307 where there is weather."""
    blocks: list[Block] = []
    address = BASE + len(MARKER)
    for model in (COMMON, TRACKERS, LOCATION, *((WEATHER,) if weather else ())):
        address = _add(blocks, model, address, tuple(tracker_ids) if model.repeated else ())
    return SunSpecMap(tuple(tracker_ids), tuple(blocks))


def _add(blocks: list[Block], model: Model, address: int, tracker_ids: tuple[str, ...]) -> int:
    """Append a model's blocks and return the address behind them."""
    length = model.length(len(tracker_ids))
    blocks.append(Block(model, _place((ID, LENGTH, *model.points), address), length))
    for tracker_id in tracker_ids:
        blocks.append(Block(model, _place(model.repeated, blocks[-1].end), length, tracker_id))
    return blocks[-1].end


def _place(points: Sequence[Point], address: int) -> tuple[Placed, ...]:
    placed = []
    for point in points:
        placed.append(Placed(point, address))
        address += point.size
    return tuple(placed)


def map_table(found: SunSpecMap) -> str:
    """Return the map as a Markdown table, as `heliopanel sunspec-map` prints it."""
    rows = [
        ("address", "words", "model", "tracker", "point", "type", "scale", "units", "access", "meaning"),
        ("---",) * 10,
        (str(BASE), "2", "", "", "SunS", "string", "", "", "R", "marker"),
        *(_row(block, placed) for block, placed in found.placed()),
        (str(found.end - len(END)), "2", "", "", "end", "uint16", "", "", "R", "0xFFFF, 0"),
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows) + "\n"


def _row(block: Block, placed: Placed) -> tuple[str, ...]:
    point = placed.point
    return (
        str(placed.address),
        str(point.size),
        str(block.model.number),
        block.tracker_id or "",
        point.name,
        point.type.value,
        f"10^{point.scale}" if point.scale else "",
        point.units,
        "RW" if point.writable else "R",
        point.text,
    )
