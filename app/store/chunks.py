"""Frames packed tightly: scaled integers, their differences down each column, zlib; at most 900 a chunk.

Layout: version byte, then zlib of the header (frames, columns, bytes of a difference, whether there are
gaps), the first row, the map of gaps (one bit a value, set where the value is missing), and the
differences row by row. Rows, because numpy sums many short columns side by side faster than one by one.
"""

import struct
import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.store.store import StoreFailed
from app.tracker.memory.recording import COLUMNS, Frames

CHUNK_FRAMES = 900
VERSION = 1
LEVEL = 6
WIDTHS = (2, 4, 8)
HEADER = struct.Struct("<IHBB")
LARGEST = 2**53
CORRECTIONS = ("correction_azimuth_deg", "correction_elevation_deg")
BESIDE = ("azimuth_dps", "elevation_dps", "supply_v", "wind_mps", "wind_mean_mps", "irradiance_wm2")
LAYOUTS = {
    len(names): [COLUMNS.index(name) for name in names]
    for names in (
        COLUMNS,
        tuple(name for name in COLUMNS if name not in BESIDE),
        tuple(name for name in COLUMNS if name not in (*BESIDE, *CORRECTIONS)),
    )
}
"""Which columns chunks of so many columns hold: all; before drive and weather were kept, read as unknown;
and before there was a correction: nothing was corrected then, so it is read as zero."""
BESIDE_AT = [COLUMNS.index(name) for name in BESIDE]
LONGEST_BODY = HEADER.size + len(COLUMNS) * (8 + CHUNK_FRAMES * 9)

STEPS_PER_UNIT = {"activity": 1.0}
"""Steps per unit of a column where they are not 1,000 (0.001 degrees, 1 ms)."""

SCALE = np.array([STEPS_PER_UNIT.get(name, 1000.0) for name in COLUMNS])
SCALES = np.tile(SCALE, (CHUNK_FRAMES, 1))


class ChunkDamaged(StoreFailed):
    """These bytes are not a chunk that this software can read."""


def encode(frames: Frames) -> bytes:
    """Return one chunk of at most 900 frames, to 0.001 degrees and 1 ms; what is not finite is missing."""
    if not 1 <= len(frames) <= CHUNK_FRAMES:
        raise ValueError(f"A chunk holds 1 to {CHUNK_FRAMES} frames, not {len(frames)}.")
    missing = ~np.isfinite(frames.values)
    steps = _steps(frames.values, missing)
    differences = np.diff(steps, axis=0, prepend=steps[:1])
    width = _width(differences)
    header = HEADER.pack(len(frames), len(COLUMNS), width, bool(missing.any()))
    gaps = np.packbits(missing).tobytes() if missing.any() else b""
    body = header + steps[0].astype("<i8").tobytes() + gaps + differences.astype(f"<i{width}").tobytes()
    return bytes([VERSION]) + zlib.compress(body, LEVEL)


def encode_all(frames: Frames) -> list[bytes]:
    """Return the chunks of any number of frames, in order."""
    pieces = range(0, len(frames), CHUNK_FRAMES)
    return [encode(Frames(frames.values[begin : begin + CHUNK_FRAMES])) for begin in pieces]


def decode(chunk: bytes) -> Frames:
    """Return the frames of one chunk, or raise `ChunkDamaged`."""
    return decode_all([chunk])


def decode_all(chunks: Sequence[bytes]) -> Frames:
    """Return the frames of chunks one after the other, or raise `ChunkDamaged`."""
    bodies = [_open(chunk) for chunk in chunks]
    values = np.zeros((sum(body.rows for body in bodies), len(COLUMNS)))
    begin = 0
    for body in bodies:
        rows = values[begin : begin + body.rows]
        if body.columns == len(COLUMNS):
            _unpack(body, SCALES, rows)
        else:
            held = LAYOUTS[body.columns]
            rows[:, BESIDE_AT] = np.nan
            rows[:, held] = _unpack(body, SCALES[:, held], np.empty((body.rows, body.columns)))
        begin += body.rows
    return Frames(values)


def join(parts: Sequence[Frames]) -> Frames:
    """Return frames one after the other; none gives empty frames."""
    return Frames(np.concatenate([part.values for part in parts]) if parts else np.empty((0, len(COLUMNS))))


def _steps(values: NDArray[np.float64], missing: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return whole steps; a missing value repeats the one before it, so that gaps cost nothing."""
    with np.errstate(over="ignore"):
        steps = np.rint(np.where(missing, 0.0, values) * SCALE)
    if np.abs(steps).max() > LARGEST:
        raise ValueError("A frame holds a number too large to be stored; check where it comes from.")
    if missing.any():
        rows = np.arange(len(values)).reshape(-1, 1)
        steps = np.take_along_axis(steps, np.maximum.accumulate(np.where(missing, 0, rows)), axis=0)
    whole: NDArray[np.int64] = steps.astype(np.int64)
    return whole


def _width(differences: NDArray[np.int64]) -> int:
    """Return how many bytes the largest difference needs."""
    largest = int(np.abs(differences).max())
    return next(width for width in WIDTHS if largest < 1 << (8 * width - 1))


@dataclass(frozen=True, slots=True)
class _Body:
    """What a chunk's header says, and the whole of what was compressed."""

    rows: int
    columns: int
    width: int
    has_gaps: bool
    content: bytes

    @property
    def gap_bytes(self) -> int:
        """Return how long the map of gaps is."""
        return -(-self.rows * self.columns // 8) if self.has_gaps else 0

    @property
    def length(self) -> int:
        """Return how long the content must be."""
        return HEADER.size + self.gap_bytes + self.columns * (8 + self.rows * self.width)


def _open(chunk: bytes) -> _Body:
    try:
        content = _inflate(chunk)
        rows, columns, width, has_gaps = HEADER.unpack_from(content)
    except (ValueError, struct.error, zlib.error) as error:
        raise ChunkDamaged(f"A chunk of {len(chunk)} bytes is damaged: {error}.") from error
    body = _Body(rows, columns, width, bool(has_gaps), content)
    if columns not in LAYOUTS or width not in WIDTHS or not 1 <= rows <= CHUNK_FRAMES:
        raise ChunkDamaged(f"A chunk says that it has {rows} frames of {columns} columns; it is damaged.")
    if len(content) != body.length:
        raise ChunkDamaged(f"A chunk of {rows} frames has {len(content)} bytes, not {body.length}.")
    return body


def _inflate(chunk: bytes) -> bytes:
    if chunk[:1] != bytes([VERSION]):
        raise ValueError(f"it begins with {chunk[:1].hex() or 'nothing'}, not with version {VERSION}")
    inflater = zlib.decompressobj()
    content = inflater.decompress(memoryview(chunk)[1:], LONGEST_BODY)
    if not inflater.eof:
        raise ValueError("it is cut short or too long")
    return content


def _unpack(body: _Body, scales: NDArray[np.float64], into: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the values of one chunk, written; sums of whole numbers below 2**53 are exact in floats."""
    gaps_at = HEADER.size + 8 * body.columns
    differences = np.frombuffer(body.content, f"<i{body.width}", into.size, gaps_at + body.gap_bytes)
    steps = differences.reshape(into.shape).astype(np.float64)
    steps[0] = np.frombuffer(body.content, "<i8", body.columns, HEADER.size)
    np.add.accumulate(steps, axis=0, out=steps)
    np.divide(steps, scales[: body.rows], out=into)
    if body.has_gaps:
        packed = np.frombuffer(body.content, np.uint8, body.gap_bytes, gaps_at)
        into[np.unpackbits(packed, count=into.size).view(np.bool_).reshape(into.shape)] = np.nan
    return into
