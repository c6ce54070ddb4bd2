"""The manual: the site of all documents as `make docs` builds it, served to who may read pages."""

from pathlib import Path

from starlette.responses import Response
from starlette.staticfiles import StaticFiles
from starlette.types import Scope

from app.base.message import N_
from app.base.own import own_folder
from app.web.http.assets import ASK_AGAIN
from app.web.http.errors import NotFound

PATH = "/manual"
NOT_BUILT = N_(
    "This installation has no manual. In a source checkout, make docs builds the manual; the "
    "guide is available without it."
)


class Manual(StaticFiles):
    """The built site, or a sentence that says how it is built.

    A wheel carries what the site has of the documents unchanged, such as pictures, only with the documents.
    """

    def __init__(self, folder: Path, documents: Path) -> None:
        super().__init__(directory=folder, check_dir=False, html=True)
        self.all_directories.append(documents)
        self._front = folder / "index.html"

    @property
    def is_built(self) -> bool:
        """Return whether there is anything to read."""
        return self._front.is_file()

    async def check_config(self) -> None:
        """Accept that the folder is not there: `get_response` tells what to do about it."""

    async def get_response(self, path: str, scope: Scope) -> Response:
        """Return a file of the site."""
        if not self.is_built:
            raise NotFound(NOT_BUILT)
        response = await super().get_response(path, scope)
        response.headers["Cache-Control"] = ASK_AGAIN
        return response


def own_manual() -> Manual:
    """Return the manual of this installation."""
    return Manual(own_folder("manual"), own_folder("docs"))
