"""What a simulated drive knows at its next start, and where it keeps that."""

import json
import os
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Protocol

from app.tracker.settings.config import Orientation, TrackerConfig

FIRST_STAND = Orientation(12.40, 6.60)
UNKNOWN_OFFSET = Orientation(90.0, 30.0)


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


class Memory(Protocol):
    """Where one drive keeps its positions.

    With `own_power` the drive outlives the program, as a real one does: it counts on while its axes turn, and
    what is kept in mid-motion is where they come to rest once no command comes any more.
    """

    own_power: bool

    def recall(self) -> PositionMemory | None:
        """Return what was kept, None if nothing was or it is damaged."""

    def keep(self, memory: PositionMemory) -> None:
        """Take the place of what was kept."""


class PositionFile:
    """A file of one drive that loses its power with the program: in mid-motion it loses its zero."""

    own_power = False

    def __init__(self, path: Path) -> None:
        self._path = path

    def recall(self) -> PositionMemory | None:
        """Return what the file holds, None if there is no file or it is damaged."""
        try:
            found = json.loads(self._path.read_text(encoding="utf-8"))
            return PositionMemory(
                azimuth=AxisMemory(**found["azimuth"]),
                elevation=AxisMemory(**found["elevation"]),
                boot_count=int(found["boot_count"]),
                trusted=bool(found["trusted"]),
            )
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def keep(self, memory: PositionMemory) -> None:
        """Replace the file in one step, so that it is never half written."""
        self._path.parent.mkdir(parents=True, exist_ok=True)
        partial = self._path.with_suffix(".partial")
        partial.write_text(json.dumps(asdict(memory)), encoding="utf-8")
        os.replace(partial, self._path)


class Keeper:
    """Keeps what one drive knows, no oftener than it changes; without a memory it forgets."""

    def __init__(self, memory: Memory | None, config: TrackerConfig) -> None:
        self._memory = memory
        known = _power_up(None if memory is None else memory.recall(), config)
        self._own_power = memory is not None and memory.own_power
        self.known = replace(known, trusted=known.trusted or self._own_power)
        self.true = self.known.trusted
        """Whether what is kept is true as long as nothing is commanded."""
        self._kept: PositionMemory | None = None
        if not known.trusted:
            self._write(self.known)

    @property
    def counts(self) -> bool:
        """Return whether what is kept follows axes that turn."""
        return not self.true and self._own_power

    def disturb(self, here: PositionMemory) -> None:
        """Note that the axes may turn from now on."""
        if self.true:
            self.true = False
            if not self._own_power:
                self._write(replace(here, trusted=False))

    def follow(self, rest: PositionMemory) -> None:
        """Keep where axes that turn come to rest if they are left alone."""
        self._write(replace(rest, trusted=True))

    def settle(self, here: PositionMemory) -> None:
        """Keep where the axes stand or come to rest for certain."""
        self.true = True
        self._write(replace(here, trusted=True))

    def _write(self, memory: PositionMemory) -> None:
        if self._memory is not None and memory != self._kept:
            self._memory.keep(memory)
            self._kept = memory


def _power_up(found: PositionMemory | None, config: TrackerConfig) -> PositionMemory:
    """Return what the drive knows at start: all of it if the memory is trusted, else no zero."""
    if found is not None and found.trusted:
        return found
    azimuth_deg = found.azimuth.true_deg if found else config.azimuth.clamp(FIRST_STAND.azimuth_deg)
    elevation_deg = found.elevation.true_deg if found else config.elevation.clamp(FIRST_STAND.elevation_deg)
    return PositionMemory(
        azimuth=AxisMemory(azimuth_deg, UNKNOWN_OFFSET.azimuth_deg, homed=False),
        elevation=AxisMemory(elevation_deg, UNKNOWN_OFFSET.elevation_deg, homed=False),
        boot_count=found.boot_count + 1 if found else 1,
        trusted=False,
    )
