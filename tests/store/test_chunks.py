"""Chunks give back what was packed, to 0.001 degrees and 1 ms, and refuse what is damaged."""

import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from app.store.chunks import (
    BESIDE,
    CHUNK_FRAMES,
    HEADER,
    SCALE,
    ChunkDamaged,
    decode,
    decode_all,
    encode,
    encode_all,
)
from app.tracker.memory.recording import COLUMNS, Frames
from tests.store.tracked_day import tracked_day

WIDEST_ROUNDING = 1e-9
MOST_BYTES_A_VALUE = 2.0

numbers = st.one_of(
    st.floats(-1e6, 1e6),
    st.floats(0.0, 360.0),
    st.sampled_from([np.nan, np.inf, -np.inf, 0.0, 359.9996, -0.0004]),
)
some_frames = st.integers(1, 40).flatmap(
    lambda rows: arrays(np.float64, (rows, len(COLUMNS)), elements=numbers)
)


@given(some_frames)
def test_frames_come_back_to_the_stated_resolution(values: NDArray[np.float64]) -> None:
    chunk = encode(Frames(values))
    back = decode(chunk).values
    known = np.isfinite(values)
    assert np.array_equal(np.isfinite(back), known)
    off = np.abs(back - values) * SCALE
    assert off[known].max(initial=0.0) <= 0.5 + WIDEST_ROUNDING * 1e3
    assert encode(Frames(back)) == chunk, "packing again changes nothing"


def test_a_day_is_split_into_full_chunks_and_comes_back() -> None:
    frames = tracked_day(2000)
    chunks = encode_all(frames)
    assert [len(decode(chunk)) for chunk in chunks] == [CHUNK_FRAMES, CHUNK_FRAMES, 200]
    np.testing.assert_allclose(decode_all(chunks).values, frames.values, atol=0.00051, equal_nan=True)


def test_a_typical_tracked_day_takes_at_most_two_bytes_a_value() -> None:
    frames = tracked_day(9000, begin_s=30_000.0)
    assert sum(map(len, encode_all(frames))) <= MOST_BYTES_A_VALUE * frames.values.size


@pytest.mark.parametrize("rows", [0, CHUNK_FRAMES + 1])
def test_a_chunk_has_a_size(rows: int) -> None:
    with pytest.raises(ValueError, match="holds 1 to 900 frames"):
        encode(Frames(np.zeros((rows, len(COLUMNS)))))


def test_a_number_out_of_all_proportion_is_refused() -> None:
    values = np.zeros((3, len(COLUMNS)))
    values[1, 4] = 1e300
    with pytest.raises(ValueError, match="too large to be stored"):
        encode(Frames(values))


def _packed(body: bytes) -> bytes:
    return b"\x01" + zlib.compress(body)


@pytest.mark.parametrize(
    ("damaged", "sentence"),
    [
        (b"", "begins with nothing"),
        (b"\x02abc", "begins with 02, not with version 1"),
        (b"\x01abc", "incorrect header check"),
        (encode(Frames(np.zeros((5, len(COLUMNS)))))[:-3], "cut short"),
        (_packed(b"\x00" * 10_000_000), "cut short or too long"),
        (_packed(b"abc"), "damaged"),
        (_packed(HEADER.pack(5, len(COLUMNS) + 1, 2, 0)), "5 frames of 20 columns"),
        (_packed(HEADER.pack(5, len(COLUMNS), 3, 0)), "5 frames of 19 columns"),
        (_packed(HEADER.pack(0, len(COLUMNS), 2, 0)), "0 frames of 19 columns"),
        (_packed(HEADER.pack(5, len(COLUMNS), 2, 0)), "not 350"),
    ],
)
def test_damage_is_told(damaged: bytes, sentence: str) -> None:
    with pytest.raises(ChunkDamaged, match=sentence):
        decode(damaged)


def test_a_chunk_from_before_corrections_were_recorded_is_read_with_none() -> None:
    """Eleven columns, as version 1.0 wrote them: two frames, the second of which lacks its setpoints."""
    first = [0, 0, 180_000, 45_000, 180_000, 45_000, 180_250, 45_000, 180_249, 45_001, 5]
    change = [1000, 1000, 4, -3, 4, -3, 0, 0, 1, -1, 0]
    gaps = np.zeros((2, 11), dtype=np.bool_)
    gaps[1, 6:8] = True
    body = HEADER.pack(2, 11, 2, 1) + np.array(first, "<i8").tobytes() + np.packbits(gaps).tobytes()
    frames = decode(_packed(body + np.array([[0] * 11, change], "<i2").tobytes()))
    assert frames.column("elapsed_s").tolist() == [0.0, 1.0]
    assert frames.column("measured_elevation_deg").tolist() == [45.001, 45.0]
    assert frames.column("correction_azimuth_deg").tolist() == [0.0, 0.0]
    assert frames.column("activity").tolist() == [5.0, 5.0]
    assert np.isnan(frames.values[1, 6:8]).all()
    beside = [COLUMNS.index(name) for name in BESIDE]
    assert np.isnan(frames.values[:, beside]).all()
    assert np.isfinite(np.delete(frames.values, [6, 7, *beside], axis=1)).all()


def test_a_chunk_from_before_drive_and_weather_were_recorded_is_read_without_them() -> None:
    """Thirteen columns, as they were stored before speeds, supply, wind and light came to them."""
    first = [0, 0, 180_000, 45_000, 180_000, 45_000, 180_250, 45_000, 180_249, 45_001, 300, -20, 5]
    body = HEADER.pack(1, 13, 2, 0) + np.array(first, "<i8").tobytes() + bytes(26)
    frames = decode(_packed(body))
    assert frames.column("correction_azimuth_deg").tolist() == [0.3]
    assert frames.column("activity").tolist() == [5.0]
    assert all(np.isnan(frames.column(name)).all() for name in BESIDE)


@given(st.integers(0, 10_000), st.integers(1, 255))
def test_a_flipped_byte_never_passes(place: int, change: int) -> None:
    chunk = bytearray(encode(tracked_day(60, begin_s=40000.0)))
    chunk[place % len(chunk)] ^= change
    with pytest.raises(ChunkDamaged):
        decode(bytes(chunk))
