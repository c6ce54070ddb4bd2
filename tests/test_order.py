"""Tests run longest file first, or by chance; what belongs to one file stays together."""

from tests.order import in_order

TESTS = ["a.py::one", "a.py::two", "b.py::one", "c.py::one[x]", "a.py::three"]


def test_the_longest_file_comes_first_and_unknown_ones_last() -> None:
    order = [TESTS[place] for place in in_order(TESTS, {"c.py": 9.0, "b.py": 3.0}, None)]
    assert order == ["c.py::one[x]", "b.py::one", "a.py::one", "a.py::two", "a.py::three"]


def test_a_seed_makes_one_order_and_another_seed_another() -> None:
    many = [f"{file}.py::{test}" for file in "abcdefgh" for test in range(9)]
    orders = [in_order(many, {}, seed) for seed in ("1", "1", "2")]
    assert orders[0] == orders[1] != orders[2]
    assert sorted(orders[2]) == list(range(len(many)))


def test_by_chance_too_a_file_stays_together() -> None:
    order = [TESTS[place][0] for place in in_order(TESTS, {}, "1")]
    assert len([here for here, before in zip(order[1:], order, strict=False) if here != before]) == 2
