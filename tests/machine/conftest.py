"""The proofs that take an hour, or a clock of their own, are collected by `make soak` alone."""

from tests.soak import SOAK

collect_ignore = [] if SOAK else ["test_clock_jump.py", "test_viewers.py"]
