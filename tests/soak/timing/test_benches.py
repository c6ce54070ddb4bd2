"""Every benchmark runs, small: none of them rots unseen, and every row says what came of it."""

from importlib import import_module

import pytest

from bench.__main__ import names, section
from bench.table import NotMeasured

NOT_SMALL = {"lighthouse"}
"""Lighthouse needs Node.js from the network and half a minute a page."""


def has_small(name: str) -> bool:
    return hasattr(import_module(f"bench.{name}"), "SMALL")


@pytest.mark.parametrize(
    "name", sorted(name for name in names() if has_small(name) and name not in NOT_SMALL)
)
def test_every_benchmark_runs_small(name: str) -> None:
    bench = import_module(f"bench.{name}")
    try:
        rows = bench.measure(bench.SMALL)
    except NotMeasured as why:
        pytest.fail(f"{name} was not measured: {why}")
    assert rows
    for row in rows:
        assert row.name
        assert row.ours
        assert row.command == f"python -m bench {name}"
        assert bool(row.against) == bool(row.verdict), "what is compared has a verdict"
    told = section(name, rows)
    assert all(row.name in told for row in rows)
    assert "at commit" in told
