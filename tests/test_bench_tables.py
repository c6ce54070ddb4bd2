"""What benchmarks make of what they measured. `make soak PART=timing` runs each of them, small."""

from bench.__main__ import names
from bench.table import at_least, at_most, beside, must_hold
from tests.soak.timing.test_benches import NOT_SMALL, has_small


def test_every_benchmark_can_be_run_small() -> None:
    assert {name for name in names() if not has_small(name)} <= NOT_SMALL


def test_from_one_on_is_good_whatever_is_compared() -> None:
    assert at_most("a", 50.0, 100.0, "ms", "c").verdict == "2"
    assert at_most("a", 200.0, 100.0, "ms", "c").verdict == "**missed**, 0.5"
    assert at_most("a", 100.01, 100.0, "ms", "c").verdict.startswith("**missed**")
    assert at_most("a", 0.0, 100.0, "ms", "c").verdict == "any number of times"
    assert at_least("a", 30.0, 60.0, "frames/s", "c").verdict == "**missed**, 0.5"
    assert at_least("a", 60.0, 60.0, "frames/s", "c").verdict == "1"
    assert beside("a", "1 s", "4 s", 4.0, "c").verdict == "4"
    assert beside("a", "4 s", "1 s", 0.25, "c").verdict == "**behind**, 0.25"
    assert must_hold("a", "1", "0", "c", holds=False).verdict == "**missed**"
