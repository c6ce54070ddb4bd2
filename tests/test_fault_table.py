"""The table of faults is complete, and its page names every row and every test."""

import re

from tests.fault_table import PAGE, proofs, rows

OPEN = {
    28: "a measure of the clock's drift",
    30: "a start without time-zone data",
    31: "23:59:60 in an API input",
    39: "two wind sensors at one site",
    46: "a gauge of memory with an alarm",
    63: "tokens: revocation that ends open streams",
    64: "log-in throttle end to end",
    67: "a cap on viewers",
}
"""Rows without a test, and what is missing for it."""


def test_the_table_has_its_72_rows() -> None:
    assert [row.number for row in rows()] == list(range(1, 73))


def test_every_row_is_proven_or_said_to_be_open() -> None:
    proven = proofs().keys()
    assert proven <= {row.number for row in rows()}
    assert {row.number for row in rows()} - proven <= OPEN.keys()


def test_the_page_names_every_row_and_only_tests_that_prove_it() -> None:
    lines = [line for line in PAGE.read_text().splitlines() if line.startswith("| ") and line[2].isdigit()]
    tests = proofs()
    assert [int(line.split(" | ")[0][2:]) for line in lines] == [row.number for row in rows()]
    for row, line in zip(rows(), lines, strict=True):
        named = set(re.findall(r"`([\w/]+\.py::\w+)`", line))
        known = {test.removeprefix("tests/") for test in tests.get(row.number, [])}
        assert named <= known, f"renew the page (python -m tests.fault_table --measured): row {row.number}"
        assert bool(named) == bool(known), f"renew the page: row {row.number}"
