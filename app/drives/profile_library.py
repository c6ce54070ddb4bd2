"""The profiles that may be chosen by name: those that ship, and the engineer's own in the data folder."""

from functools import lru_cache
from pathlib import Path

from app.base.message import say
from app.drives.profile import PROFILES, SUFFIX, Profile, ProfileError, known_profiles, read_profile
from app.drives.profile_rules import NAME


class ProfileLibrary:
    """Two folders. A name never leads out of them: a path to any other file is for the command line only."""

    def __init__(self, own: Path | None = None) -> None:
        self._own = own

    def names(self) -> tuple[str, ...]:
        """Return every name that can be loaded; a file whose name could not be asked for is left out."""
        own = () if self._own is None else (path.stem for path in self._own.glob(f"*{SUFFIX}"))
        return tuple(sorted({*known_profiles(), *filter(NAME.fullmatch, own)}))

    def load(self, name: str) -> Profile:
        """Return a profile by its name, a shipped one before one's own, or raise `ProfileError`."""
        if NAME.fullmatch(name):
            for folder in (PROFILES, self._own):
                path = None if folder is None else folder / f"{name}{SUFFIX}"
                if path is not None and path.is_file():
                    return _read(path, path.stat().st_mtime_ns)
        raise ProfileError(
            say(
                "There is no drive profile {name}. Choose one of {join}{advice}.",
                name=repr(name),
                join=", ".join(self.names()),
                advice=self._advice(),
            )
        )

    def _advice(self) -> str:
        return (
            ""
            if self._own is None
            else say(", or save your own as name{suffix} in {own}", suffix=SUFFIX, own=self._own)
        )


@lru_cache(maxsize=64)
def _read(path: Path, changed_ns: int) -> Profile:  # the time of the last change belongs to the key
    return read_profile(path)
