"""The table of faults is complete, and its page names every row and every test."""

import re

from tests.fault_table import PAGE, proofs, rows


def test_the_table_has_its_first_72_rows_and_those_that_came_after() -> None:
    numbers = [row.number for row in rows()]
    assert numbers[:72] == list(range(1, 73))
    assert numbers == sorted(set(numbers))


def test_every_row_has_a_test_with_its_number() -> None:
    assert {row.number for row in rows()} == proofs().keys()


def test_the_page_names_every_row_and_only_tests_that_prove_it() -> None:
    lines = [line for line in PAGE.read_text().splitlines() if line.startswith("| ") and line[2].isdigit()]
    tests = proofs()
    assert [int(line.split(" | ")[0][2:]) for line in lines] == [row.number for row in rows()]
    for row, line in zip(rows(), lines, strict=True):
        named = set(re.findall(r"`([\w/]+\.py::\w+)`", line))
        known = {test.removeprefix("tests/") for test in tests.get(row.number, [])}
        assert named <= known, f"renew the page (python -m tests.fault_table): row {row.number}"
        assert bool(named) == bool(known), f"renew the page: row {row.number}"


def test_every_row_has_a_measured_time_a_shown_sentence_and_a_recovery() -> None:
    for line in PAGE.read_text().splitlines():
        if line.startswith("| ") and line[2].isdigit():
            number, _, _, noticed, _, shown, recovery, _ = line.removeprefix("| ").split(" | ")
            assert all((noticed, shown, recovery)), f"row {number} says not all that its tests saw"
