"""Orders about settings as they are: to lock them, and to go back to what was."""

from dataclasses import dataclass
from typing import ClassVar, Literal

from app.tracker.values.order_spec import setting


@dataclass(frozen=True, slots=True)
class UndoSettings:
    """Set a tracker as it was before its settings were changed last, its drive aside."""

    tracker_id: str
    kind: Literal["undo_settings"] = "undo_settings"
    spec: ClassVar = setting(sealed=True)


@dataclass(frozen=True, slots=True)
class UndoSiteSettings:
    """Set what holds for the site, its place and clock aside, as it was before it was changed last."""

    kind: Literal["undo_site_settings"] = "undo_site_settings"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class LockSettings:
    """Keep what was commissioned as it is: settings, drive, mount, strategy, zero and location."""

    tracker_id: str
    kind: Literal["lock_settings"] = "lock_settings"
    spec: ClassVar = setting()


@dataclass(frozen=True, slots=True)
class UnlockSettings:
    """Let what was commissioned be changed again, for a reason."""

    tracker_id: str
    reason: str
    kind: Literal["unlock_settings"] = "unlock_settings"
    spec: ClassVar = setting()


LockOrder = LockSettings | UnlockSettings
"""What concerns the lock on a tracker's settings."""
