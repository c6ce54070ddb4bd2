"""Builds the site of the documents in a folder of its own, finishes it, and lets it be seen only whole."""

import hashlib
import re
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from tools.manual.links import faults

ROOT = Path(__file__).resolve().parents[2]
CONFIG = "zensical.toml"
NOT_SERVED = ("404.html", "sitemap.xml")
"""The panel has its own page for what is not there, and no search engine reads it."""

INLINE_SCRIPT = re.compile(r"<script>(.*?)</script>", re.DOTALL)
ADDED_STYLE = re.compile(r'(\w+)\.appendChild\(\w+\("style",\{\},(\w+\.toString\(\))\)\)')
ADOPTED = r"\1.adoptedStyleSheets=[(sheet=>(sheet.replaceSync(\2),sheet))(new CSSStyleSheet)]"
"""A script adds the style of the search as an element, which no strict policy allows; a sheet is allowed."""

AS_WRITTEN = re.compile(r"(<pre\b.*?</pre>)", re.DOTALL)
INDENTATION = re.compile(r"\n\s+")

INLINE_STYLE = ' style="text-align: right;"'
COLOURS = re.compile("\x1b\\[[0-9;]*m")


class BrokenSite(Exception):
    """The documents make no whole site; the message says where."""


def build(target: Path) -> None:
    """Build the site and put it where `target` says, in the place of an earlier one."""
    with TemporaryDirectory() as folder:
        built = _generate(Path(folder))
        for name in NOT_SERVED:
            (built / name).unlink(missing_ok=True)
        _adopt_style(built / "assets" / "javascripts")
        for page in built.rglob("*.html"):
            finish(page, built)
        if found := faults(built):
            raise BrokenSite("\n".join(found))
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(built, target)


def _generate(folder: Path) -> Path:
    shutil.copytree(ROOT / "docs", folder / "docs")
    shutil.copy2(ROOT / CONFIG, folder / CONFIG)
    command = (sys.executable, "-m", "zensical", "build", "--strict")
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, timeout=500)
    if done.returncode != 0:
        raise BrokenSite(COLOURS.sub("", done.stdout + done.stderr).partition("Traceback")[0])
    return folder / "manual"


def _adopt_style(scripts: Path) -> None:
    (bundle,) = scripts.glob("bundle.*.js")
    text, changed = ADDED_STYLE.subn(ADOPTED, bundle.read_text())
    if changed != 1:
        raise BrokenSite(f"{bundle.name} adds {changed} elements of style, not one: see ADDED_STYLE.")
    bundle.write_text(text)


def finish(page: Path, site: Path) -> None:
    """Move scripts and styles that are in a page into files: the panel's security policy runs no other.

    The indentation of its elements goes: it is a third of the site, which every installation carries.
    """
    scripts = site / "assets" / "javascripts"
    up = "../" * len(page.relative_to(site).parent.parts)

    def moved(script: re.Match[str]) -> str:
        name = f"page.{hashlib.sha256(script[1].encode()).hexdigest()[:8]}.js"
        (scripts / name).write_text(script[1])
        return f'<script src="{up}assets/javascripts/{name}"></script>'

    text = INLINE_SCRIPT.sub(moved, page.read_text())
    page.write_text(unindented(text.replace(INLINE_STYLE, ' class="number"')))


def unindented(html: str) -> str:
    """Return it without the spaces before each line, but for text that is shown as it is written."""
    parts = AS_WRITTEN.split(html)
    return "".join(part if place % 2 else INDENTATION.sub("\n", part) for place, part in enumerate(parts))
