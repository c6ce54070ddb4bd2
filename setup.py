"""Carries the folders beside the program into the wheel, where `app.base.own` finds them."""

import filecmp
import os
import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

FOLDERS = ("alembic", "docs", "static", "templates")
BUILT = ("manual",)
"""Carried where `make docs` has built it."""

NEVER_CARRIED = shutil.ignore_patterns("__pycache__", "*.pyc", ".*", "show.gif")
"""The moving picture is the README's alone."""


def left_out(folder: str, names: list[str]) -> set[str]:
    """Return what is not carried of a folder; pictures of the manual come with the documents already."""
    beside = Path("docs", *Path(folder).parts[1:])
    same, _, _ = filecmp.cmpfiles(folder, beside, names) if folder.startswith(BUILT) else ((), (), ())
    return {*NEVER_CARRIED(folder, names), *same}


class BuildWithFolders(build_py):
    """Copies the folders into the package; an editable install reads them where they are."""

    def run(self) -> None:
        """Build from nothing: what an earlier build left behind may be gone from the sources."""
        built = Path(self.build_lib) / "app"
        if not self.editable_mode:
            shutil.rmtree(built, ignore_errors=True)
        super().run()
        if not self.editable_mode:
            for folder in (*FOLDERS, *filter(os.path.isdir, BUILT)):
                shutil.copytree(folder, built / "_carried" / folder, ignore=left_out)


setup(cmdclass={"build_py": BuildWithFolders})
