"""Static files under one hash: a page that is new never runs with a script that is old."""

import hashlib
from pathlib import Path

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

FOREVER = "public, max-age=31536000, immutable"
ASK_AGAIN = "no-cache"


class Assets(StaticFiles):
    """The static tree, served below `/s/<hash over all files>/`."""

    def __init__(self, folder: Path) -> None:
        super().__init__(directory=folder, check_dir=False)
        self.digest = _digest(folder)

    def url(self, path: str) -> str:
        """Return the address of a file such as `css/hmi.css`."""
        return f"/s/{self.digest}/{path}"

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file; only the address with the right hash may be kept for ever."""
        digest, _, inner = path.partition("/")
        response = await super().get_response(inner, scope)
        response.headers["Cache-Control"] = FOREVER if digest == self.digest else ASK_AGAIN
        return response


def _digest(folder: Path) -> str:
    total = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            total.update(str(file.relative_to(folder)).encode())
            total.update(file.read_bytes())
    return total.hexdigest()[:16]
