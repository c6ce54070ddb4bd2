"""What benchmarks make of what they measured. `make soak PART=timing` runs each of them, small."""

from bench.__main__ import names, renewed, section
from bench.table import Row, at_least, at_most, beside, must_hold, spread, worst
from tests.soak.timing.test_benches import NOT_SMALL, has_small


def test_every_benchmark_can_be_run_small() -> None:
    assert {name for name in names() if not has_small(name)} <= NOT_SMALL


def test_from_one_on_is_good_whatever_is_compared() -> None:
    assert at_most("a", 50.0, 100.0, "ms", "c").verdict == "2"
    assert at_most("a", 200.0, 100.0, "ms", "c").verdict == "**missed**, 0.5"
    assert at_most("a", 0.0, 100.0, "ms", "c").verdict == "any number of times"
    assert at_least("a", 30.0, 60.0, "frames/s", "c").verdict == "**missed**, 0.5"
    assert at_least("a", 60.0, 60.0, "frames/s", "c").verdict == "1"
    assert beside("a", "1 s", "4 s", 4.0, "c").verdict == "4"
    assert beside("a", "4 s", "1 s", 0.25, "c").verdict == "**behind**, 0.25"
    assert must_hold("a", "1", "0", "c", holds=False).verdict == "**missed**"


def test_a_value_just_beyond_its_bound_is_missed() -> None:
    assert at_most("a", 100.01, 100.0, "ms", "c").verdict.startswith("**missed**")


def test_few_values_have_no_99_9th_percentile() -> None:
    few, many = [float(value) for value in range(999)], [float(value) for value in range(1000)]
    assert "p99.9" not in spread(few)
    assert worst(few) == ("maximum", 998.0)
    assert worst(many) == ("p99.9", 998.0)
    assert "p99.9 998" in spread(many)


def test_a_section_that_is_measured_anew_takes_the_place_of_the_old_one() -> None:
    rows = [Row("what", "1 ms", "at most 2 ms", "2", "python -m bench sun")]
    before = renewed("", {"sun": section("sun", rows), "jog": section("jog", rows)})
    after = renewed(before, {"sun": section("sun", [*rows, *rows])})
    assert after.count("## sun:") == after.count("## jog:") == 1
    assert after.count("| what |") == before.count("| what |") + 1
