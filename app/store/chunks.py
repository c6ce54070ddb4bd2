"""Frames packed as columns: scaled integers, their differences, zlib. At most 900 frames a chunk.

Layout: version byte, then zlib of the header (frames, columns, bytes of a difference, whether there are
gaps), the first value of every column, the map of gaps (one bit a value, set where the value is missing),
and the differences, one column after the other.
"""

import struct
import zlib
from collections.abc import Iterable, Sequence

import numpy as np
from numpy.typing import NDArray

from app.tracker.recording import COLUMNS, Frames

CHUNK_FRAMES = 900
VERSION = 1
LEVEL = 6
HEADER = struct.Struct("<IHBB")
LARGEST = 2**53
LONGEST_BODY = HEADER.size + len(COLUMNS) * (8 + CHUNK_FRAMES * 9)

STEPS_PER_UNIT = {"activity": 1.0}
"""Steps per unit of a column where they are not 1,000 (0.001 degrees, 1 ms)."""

SCALE = np.array([[STEPS_PER_UNIT.get(name, 1000.0)] for name in COLUMNS])


class ChunkDamaged(ValueError):
    """These bytes are not a chunk that this software can read."""


def encode(frames: Frames) -> bytes:
    """Return one chunk of at most 900 frames, to 0.001 degrees and 1 ms; what is not finite is missing."""
    if not 1 <= len(frames) <= CHUNK_FRAMES:
        raise ValueError(f"A chunk holds 1 to {CHUNK_FRAMES} frames, not {len(frames)}.")
    values = frames.values.T
    missing = ~np.isfinite(values)
    steps = _steps(values, missing)
    differences = np.diff(steps, axis=1, prepend=steps[:, :1])
    width = _width(differences)
    header = HEADER.pack(len(frames), len(COLUMNS), width, bool(missing.any()))
    gaps = np.packbits(missing, axis=1).tobytes() if missing.any() else b""
    body = header + steps[:, 0].astype("<i8").tobytes() + gaps + differences.astype(f"<i{width}").tobytes()
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
    return join([_decode(chunk) for chunk in chunks])


def join(parts: Iterable[Frames]) -> Frames:
    """Return frames one after the other; none gives empty frames."""
    columns = [part.values.T for part in parts]
    return Frames(np.concatenate(columns, axis=1).T if columns else np.empty((0, len(COLUMNS))))


def _steps(values: NDArray[np.float64], missing: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Return whole steps; a missing value repeats the one before it, so that gaps cost nothing."""
    steps = np.rint(np.where(missing, 0.0, values) * SCALE)
    if np.abs(steps).max() > LARGEST:
        raise ValueError("A frame holds a number too large to be stored; check where it comes from.")
    if missing.any():
        last_seen = np.maximum.accumulate(np.where(missing, 0, np.arange(values.shape[1])), axis=1)
        steps = np.take_along_axis(steps, last_seen, axis=1)
    whole: NDArray[np.int64] = steps.astype(np.int64)
    return whole


def _width(differences: NDArray[np.int64]) -> int:
    """Return how many bytes the largest difference needs."""
    largest = int(np.abs(differences).max())
    return next(width for width in (2, 4, 8) if largest < 1 << (8 * width - 1))


def _decode(chunk: bytes) -> Frames:
    try:
        return _unpack(_inflate(chunk))
    except (ValueError, struct.error, zlib.error) as error:
        raise ChunkDamaged(f"A chunk of {len(chunk)} bytes is damaged: {error}.") from error


def _inflate(chunk: bytes) -> bytes:
    if chunk[:1] != bytes([VERSION]):
        raise ValueError(f"it begins with {chunk[:1].hex() or 'nothing'}, not with version {VERSION}")
    inflater = zlib.decompressobj()
    body = inflater.decompress(memoryview(chunk)[1:], LONGEST_BODY)
    if not inflater.eof:
        raise ValueError("it is cut short or too long")
    return body


def _unpack(body: bytes) -> Frames:
    rows, columns, width, has_gaps = HEADER.unpack_from(body)
    if columns != len(COLUMNS) or width not in (2, 4, 8) or not 1 <= rows <= CHUNK_FRAMES:
        raise ValueError(f"it says {rows} frames of {columns} columns in {width} bytes")
    gap_bytes = -(-rows // 8)
    at = HEADER.size + 8 * columns
    first = np.frombuffer(body, "<i8", columns, HEADER.size)
    differences_at = at + (columns * gap_bytes if has_gaps else 0)
    differences = np.frombuffer(body, f"<i{width}", columns * rows, differences_at).reshape(columns, rows)
    values = (np.cumsum(differences, axis=1, dtype=np.int64) + first[:, None]) / SCALE
    if has_gaps:
        packed = np.frombuffer(body, np.uint8, columns * gap_bytes, at).reshape(columns, gap_bytes)
        values[np.unpackbits(packed, axis=1, count=rows).view(np.bool_)] = np.nan
    return Frames(values.T)
