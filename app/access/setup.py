"""The first run and the way back to it: the one-time code, and the file that resets access."""

import hmac
import os
import secrets
from dataclasses import dataclass
from pathlib import Path

CODE_FILE = "setup-code"
RESET_FILE = "reset-access"
ALPHABET = "ABCDEFGHJKLMNPQRSTUVWXYZ23456789"
PRIVATE = 0o600


@dataclass(frozen=True, slots=True)
class Setup:
    """Where the code lies, and whether only this computer can reach the panel."""

    folder: Path
    loopback: bool

    def offer(self) -> str:
        """Write a new one-time code, readable by its owner only, and return it."""
        code = "-".join("".join(secrets.choice(ALPHABET) for _ in range(4)) for _ in range(4))
        path = self.folder / CODE_FILE
        path.unlink(missing_ok=True)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, PRIVATE), "w") as file:
            file.write(code + "\n")
        return code

    def accepts(self, code: str) -> bool:
        """Return whether this is the code; without a code nothing is."""
        try:
            right = (self.folder / CODE_FILE).read_text(encoding="ascii").strip()
        except OSError:
            return False
        return hmac.compare_digest(code.strip().upper().encode(), right.encode()) and right != ""

    def used(self) -> None:
        """Forget the code."""
        (self.folder / CODE_FILE).unlink(missing_ok=True)

    def reset_wanted(self) -> bool:
        """Return whether somebody at the data folder asks to begin anew, and take the file away."""
        path = self.folder / RESET_FILE
        if not path.exists():
            return False
        path.unlink()
        return True
