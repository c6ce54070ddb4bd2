"""The chain of hashes shows what was changed, removed, added or put in another order."""

import hashlib
import json
from dataclasses import replace
from datetime import UTC, datetime, timedelta

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.audit.chain import FIRST, Link, first_break, link
from app.audit.difference import difference
from app.audit.entry import LONGEST, Entry, Sealed, seal, told

NOON = datetime(2027, 6, 21, 9, 40, tzinfo=UTC)


def entry(number: int) -> Entry:
    at = NOON + timedelta(seconds=number)
    return Entry(
        at, number * 1000, "boot", "trusted", "ada", "session", "10.0.0.7", "track", f"T{number}", "{}"
    )


def chain(length: int) -> list[Sealed]:
    made: list[Sealed] = []
    for number in range(1, length + 1):
        made.append(seal(entry(number), number, made[-1].hash if made else FIRST))
    return made


def links(sealed: list[Sealed]) -> list[Link]:
    return [one.link() for one in sealed]


def test_a_hash_is_sha256_over_canonical_json() -> None:
    text = json.dumps(
        {"b": "ş", "a": 1, "prev_hash": FIRST}, sort_keys=True, separators=(",", ":"), ensure_ascii=False
    )
    assert link(FIRST, {"b": "ş", "a": 1}) == hashlib.sha256(text.encode()).hexdigest()


def test_an_untouched_chain_holds() -> None:
    assert first_break(links(chain(20))) is None
    assert first_break([]) is None


@pytest.mark.parametrize(
    "values",
    [
        {"actor": "eve"},
        {"result": "refused"},
        {"utc": NOON},
        {"mono_ms": 5},
        {"before": "[]"},
        {"address": ""},
    ],
    ids=str,
)
def test_a_changed_value_is_named(values: dict[str, object]) -> None:
    made = chain(9)
    made[4] = replace(made[4], entry=replace(made[4].entry, **values))  # type: ignore[arg-type]
    found = first_break(links(made))
    assert found is not None
    assert (found.number, found.reason) == (5, "its content was changed after it was written")


@given(st.integers(2, 9), st.integers(0, 8))
def test_a_removed_record_is_seen_at_the_next(length: int, at: int) -> None:
    made = chain(length + 1)
    del made[at % length]
    found = first_break(links(made))
    assert found is not None
    assert found.number == at % length + 2
    assert "removed" in found.reason


def test_a_forged_record_that_hashes_right_does_not_follow() -> None:
    made = chain(5)
    made[2] = seal(replace(made[2].entry, actor="eve"), 3, made[1].hash)
    found = first_break(links(made))
    assert found is not None
    assert (found.number, found.reason[:29]) == (4, "it does not follow record 3: ")


def test_a_part_is_held_against_the_record_before_it() -> None:
    made = links(chain(6))
    assert first_break(made[3:], after=made[2]) is None
    broken = first_break(made[4:], after=made[2])
    assert broken is not None
    assert broken.number == 5


def test_only_what_differs_is_told_by_its_path() -> None:
    before = {"name": "a", "axes": {"azimuth": {"max_deg": 170, "min_deg": 0}}, "gone": 1}
    after = {"name": "a", "axes": {"azimuth": {"max_deg": 160, "min_deg": 0}}, "new": [1, 2]}
    assert difference(before, after) == (
        {"axes.azimuth.max_deg": 170, "gone": 1},
        {"axes.azimuth.max_deg": 160, "new": [1, 2]},
    )
    assert difference(before, before) == ({}, {})


def test_what_is_too_long_is_kept_as_its_hash_and_beginning() -> None:
    long = {"text": "x" * (2 * LONGEST)}
    kept = json.loads(told(long))
    assert kept["sha256"] == hashlib.sha256(json.dumps(long, separators=(",", ":")).encode()).hexdigest()
    assert kept["characters"] > 2 * LONGEST
    assert told({"a": "\x00"}) == '{"a":"\\u0000"}'
