"""Static files under one hash: a page that is new never runs with a script that is old."""

import hashlib
import re
from pathlib import Path

from starlette.responses import FileResponse, Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

COMMENTS = {
    ".css": re.compile(r"\s*/\*.*?\*/", re.DOTALL),
    ".js": re.compile(r"^\s*//.*\n", re.MULTILINE),
}
"""What our own scripts and styles say to who reads the sources; an eighth of what a page would load."""
VENDOR = "vendor/"
FOREVER = "public, max-age=31536000, immutable"
ASK_AGAIN = "no-cache"


class Assets(StaticFiles):
    """The static tree, served below `/s/<hash over all files>/`."""

    def __init__(self, folder: Path) -> None:
        super().__init__(directory=folder, check_dir=False)
        self.digest = _digest(folder)
        self._bare: dict[str, bytes] = {}

    def url(self, path: str) -> str:
        """Return the address of a file such as `css/hmi.css`."""
        return f"/s/{self.digest}/{path}"

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file; only the address with the right hash may be kept for ever."""
        digest, _, inner = path.partition("/")
        response = await super().get_response(inner, scope)
        if isinstance(response, FileResponse) and not inner.startswith(VENDOR):
            response = self._without_comments(inner, response)
        response.headers["Cache-Control"] = FOREVER if digest == self.digest else ASK_AGAIN
        return response

    def _without_comments(self, path: str, file: FileResponse) -> Response:
        """Return a script or a style without its comments, anything else as it is."""
        comments = COMMENTS.get(Path(path).suffix)
        if comments is None:
            return file
        if path not in self._bare:
            self._bare[path] = comments.sub("", Path(file.path).read_text(encoding="utf-8")).encode()
        kept = {name: value for name, value in file.headers.items() if name in ("etag", "last-modified")}
        return Response(self._bare[path], media_type=file.media_type, headers=kept)


def _digest(folder: Path) -> str:
    total = hashlib.sha256()
    for file in sorted(folder.rglob("*")):
        if file.is_file():
            total.update(str(file.relative_to(folder)).encode())
            total.update(file.read_bytes())
    return total.hexdigest()[:16]
