"""Carries the folders beside the program into the wheel, where `app.own` finds them."""

import os
import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

FOLDERS = ("alembic", "docs", "static", "templates")
BUILT = ("manual",)
"""Carried where `make docs` has built it."""

LEFT_OUT = shutil.ignore_patterns("__pycache__", "*.pyc", ".*")


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
                shutil.copytree(folder, built / "_carried" / folder, ignore=LEFT_OUT)


setup(cmdclass={"build_py": BuildWithFolders})
