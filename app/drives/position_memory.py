"""The position memory of a simulated drive: a small file with a trust bit."""

import json
import os
from dataclasses import asdict, dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class AxisMemory:
    """Where one axis really stands, what its encoder adds to that, and whether its zero was set."""

    true_deg: float
    offset_deg: float
    homed: bool


@dataclass(frozen=True, slots=True)
class PositionMemory:
    """What a drive knows after a power cut; `trusted` only if it was written while the axes stood still."""

    azimuth: AxisMemory
    elevation: AxisMemory
    boot_count: int
    trusted: bool


def recall(path: Path) -> PositionMemory | None:
    """Return what the file holds, None if there is no file or it is damaged."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        return PositionMemory(
            azimuth=AxisMemory(**found["azimuth"]),
            elevation=AxisMemory(**found["elevation"]),
            boot_count=int(found["boot_count"]),
            trusted=bool(found["trusted"]),
        )
    except (OSError, ValueError, KeyError, TypeError):
        return None


def remember(path: Path, memory: PositionMemory) -> None:
    """Replace the file in one step, so that it is never half written."""
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_suffix(".partial")
    partial.write_text(json.dumps(asdict(memory)), encoding="utf-8")
    os.replace(partial, path)
