"""The panels, Chromium in front of them, and what `make looks` has found to be due."""

import json
import os
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from playwright.sync_api import Browser

from tests.browser.conftest import CHROMIUM, FLAGS, browser
from tests.browser.panels import Panels
from tests.e2e.letters import environment
from tests.looks.fonts import MANY_FONTS
from tests.looks.keyboard import POINTED

__all__ = ["browser"]
DUE = json.loads(os.environ.get("HELIOPANEL_LOOKS", "{}"))
"""The pages to look at, and of each the languages with their sums: `python -m tests.looks` says which."""


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "name" in metafunc.fixturenames:
        metafunc.parametrize("name", sorted(name for name in DUE if not name.startswith("(")))


@pytest.fixture(scope="package")
def panels(browser: Browser) -> Iterator[Panels]:
    with ExitStack() as stack:
        yield Panels(browser, stack, scripts=(f"({POINTED})()",))


@pytest.fixture(scope="package")
def many(browser: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    """Run a second browser that finds many fonts."""
    fonts: Path = tmp_path_factory.mktemp("fonts") / "fonts.conf"
    fonts.write_text(MANY_FONTS)
    started = browser.browser_type.launch(executable_path=CHROMIUM, args=FLAGS, env=environment(fonts))
    yield started
    started.close()


def pytest_runtest_logreport(report: pytest.TestReport) -> None:
    """Tell what is wrong as soon as it is found."""
    if report.failed and hasattr(report, "node"):
        crash = getattr(report.longrepr, "reprcrash", None)
        print(f"\n{crash.message if crash else report.longrepr}", flush=True)
