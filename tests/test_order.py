"""Tests run in an order, and each of them once."""

from tests.order import in_order


def test_a_seed_makes_one_order_and_another_seed_another() -> None:
    many = [f"{file}.py::{test}" for file in "abcdefgh" for test in range(9)]
    orders = [in_order(many, {}, seed) for seed in ("1", "1", "2")]
    assert orders[0] == orders[1] != orders[2]
    assert sorted(orders[2]) == list(range(len(many)))
