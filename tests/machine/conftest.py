"""The proof that takes an hour is collected by `make soak` alone."""

from tests.soak import SOAK

collect_ignore = [] if SOAK else ["test_viewers.py"]
