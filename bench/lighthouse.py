"""Lighthouse: its scores for the main pages, on a slow phone as it imagines one and on a desktop"""

import json
import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from statistics import median

from bench.pages import PAGES
from bench.table import NotMeasured, Row, at_least
from tests.e2e.chromium import FLAGS, PROGRAM
from tests.e2e.integrator import Integrator
from tests.e2e.product import Product

COMMAND = "python -m bench lighthouse"
LEAST = 95
RUNS = 3
TRIES = 3
"""How often a page is tried that Lighthouse could not trace; it says then `Please run Lighthouse again`."""
Scores = tuple[int, int, int]
WANTED = Path(__file__).parent / "lighthouse"
BUILT = Path(__file__).resolve().parents[1] / "build" / "lighthouse"
MORE = {"alarms": "/alarms", "site": "/site", "sign-in": "/login"}
DEVICES = {"phone": (), "desktop": ("--preset=desktop",)}
CATEGORIES = {
    "performance": "performance",
    "accessibility": "accessibility",
    "best-practices": "best practices",
}
OURS = ("--remote-debugging-port", "--window-size")
CHROMIUM = " ".join(flag for flag in FLAGS if not flag.startswith(OURS))
OPTIONS = (
    f"--only-categories={','.join(CATEGORIES)}", f"--chrome-flags={CHROMIUM}", "--output=json",
    "--output-path=stdout", "--quiet", "--disable-full-page-screenshot", "--no-enable-error-reporting",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Size:
    """How many pages are judged."""

    pages: int = len(PAGES) + len(MORE) + 1


SMALL = Size(pages=1)


def measure(size: Size = Size()) -> list[Row]:
    """Return a row a page: what Lighthouse gives it on either device."""
    program = _program()
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder) / "data")
        try:
            pages = PAGES | MORE | {"player": f"/recordings/{_prepared(product.url)}"}
            judged = islice(pages.items(), size.pages)
            return [_row(name, _judged(program, product.url + path)) for name, path in judged]
        finally:
            product.stop()


def _program() -> Path:
    """Return Lighthouse as the lock file has it, which is brought here when it is not."""
    if not shutil.which("npm"):
        raise NotMeasured("Lighthouse needs Node.js and npm: apt-get install -y nodejs npm")
    lock, kept = WANTED / "package-lock.json", BUILT / "node_modules" / ".locked"
    if not kept.exists() or kept.read_bytes() != lock.read_bytes():
        BUILT.mkdir(parents=True, exist_ok=True)
        for name in ("package.json", "package-lock.json"):
            shutil.copyfile(WANTED / name, BUILT / name)
        quiet = ("--ignore-scripts", "--no-audit", "--no-fund", "--loglevel=error")
        subprocess.run(["npm", "ci", "--prefix", str(BUILT), *quiet], check=True)
        shutil.copyfile(lock, kept)
    return BUILT / "node_modules" / ".bin" / "lighthouse"


def _prepared(url: str) -> str:
    """Bring the plant into operation, and return the recording of a simulated day."""
    calling = Integrator(url)
    calling.place_and_time()
    calling.until_allowed("set_home")
    calling.zero()
    made = calling.post("/api/v1/simulations", {"tracker_id": "T1", "date": "2026-06-21", "step_s": 10})
    calling.close()
    return str(made["recording_id"])


def _judged(program: Path, url: str) -> dict[str, Scores]:
    return {device: _scores(program, url, options) for device, options in DEVICES.items()}


def _scores(program: Path, url: str, options: tuple[str, ...]) -> Scores:
    """Return what Lighthouse gives; where that falls short, the median of three, for others disturb it."""
    runs = [_run(program, url, options)]
    if min(runs[0]) < LEAST:
        runs += [_run(program, url, options) for _ in range(RUNS - 1)]
    performance, accessibility, practices = (round(median(given)) for given in zip(*runs, strict=True))
    return performance, accessibility, practices


def _run(program: Path, url: str, options: tuple[str, ...]) -> Scores:
    asked = [str(program), url, *OPTIONS, *options]
    for _ in range(TRIES):
        told = subprocess.run(
            asked, env=os.environ | {"CHROME_PATH": PROGRAM}, capture_output=True, text=True, timeout=180
        )
        if told.returncode == 0:
            given = json.loads(told.stdout)["categories"]
            performance, accessibility, practices = (round(100 * given[name]["score"]) for name in CATEGORIES)
            return performance, accessibility, practices
    raise NotMeasured(f"Lighthouse could not judge {url}: {told.stderr.strip()[-300:]}")


def _row(name: str, judged: dict[str, Scores]) -> Row:
    least = min(min(given) for given in judged.values())
    told = "; ".join(f"{device} {', '.join(map(str, given))}" for device, given in judged.items())
    what = f"{name}: {', '.join(CATEGORIES.values())}, the least of both devices"
    return at_least(what, least, LEAST, "of 100", COMMAND, ours=told)
