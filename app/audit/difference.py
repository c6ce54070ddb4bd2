"""What a change changed: only the values that differ, by their path."""

from typing import Any

MISSING = object()
Flat = dict[str, Any]


def difference(before: Any, after: Any) -> tuple[Flat, Flat]:
    """Return the values that differ, as they were and as they are, by paths such as `axes.azimuth.max_deg`.

    A value that was not there before, or is not there any more, is absent on that side.
    """
    old: Flat = {}
    new: Flat = {}
    _compare("", before, after, old, new)
    return old, new


def _compare(path: str, before: Any, after: Any, old: Flat, new: Flat) -> None:
    if isinstance(before, dict) and isinstance(after, dict):
        for name in sorted(before.keys() | after.keys()):
            below = f"{path}.{name}" if path else name
            _compare(below, before.get(name, MISSING), after.get(name, MISSING), old, new)
    elif before != after:
        if before is not MISSING:
            old[path] = before
        if after is not MISSING:
            new[path] = after
