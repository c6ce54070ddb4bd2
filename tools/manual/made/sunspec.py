"""The SunSpec map of a site of two trackers, as the server builds it."""

from app.gateway.sunspec_map import map_table, sunspec_map
from tools.manual.made.markdown import page

INTRODUCTION = """The registers of a site of two trackers, `T1` and `T2`, with weather. Every further
tracker adds as many words as `T2` has, and the addresses after them move. `heliopanel sunspec-map` prints the
map of the current site; [SunSpec](../integrate/sunspec.md) describes how to enable it and what its
values mean.

Addresses are counted from 0. The first register is read with function 3 or 4."""


def sunspec_page() -> str:
    """Return the page."""
    return page("SunSpec map", INTRODUCTION, map_table(sunspec_map(["T1", "T2"], weather=True)).strip())
