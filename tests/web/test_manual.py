"""The manual where it was built, and the sentence where it was not."""

from collections.abc import Callable
from pathlib import Path

import pytest
from fastapi import FastAPI

from app.web.http.manual import Manual
from tests.fakes import FakeMachine, fake_app, serving


def app_with(manual: Path) -> FastAPI:
    """Return a panel whose manual is in this folder, with the documents beside it."""
    app = fake_app(FakeMachine())
    served = Manual(manual, manual.parent / "docs")
    next(route for route in app.routes if getattr(route, "name", "") == "manual").app = served
    return app


@pytest.fixture
def written(tmp_path: Path) -> Callable[[str, str], Path]:
    """Write a file of a manual and return the manual's folder."""

    def write(name: str, text: str) -> Path:
        path = tmp_path / "manual" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return tmp_path / "manual"

    return write


async def test_a_manual_that_was_not_built_is_a_sentence(tmp_path: Path) -> None:
    async with serving(app_with(tmp_path / "none")) as browser:
        for path in ("/manual/", "/manual/install/README.html"):
            answer = await browser.get(path, headers={"Accept": "text/html"})
            assert answer.status_code == 404
            assert "make docs builds the manual" in answer.text


async def test_its_pages_come_under_the_policy_of_all_pages(written: Callable[[str, str], Path]) -> None:
    manual = written("index.html", "<h1>Manual</h1>")
    written("assets/main.0123.css", "h1 {}")
    async with serving(app_with(manual)) as browser:
        short = await browser.get("/manual")
        front = await browser.get("/manual/")
        style = await browser.get("/manual/assets/main.0123.css")
    assert short.headers["location"].endswith("/manual/")
    assert front.text == "<h1>Manual</h1>"
    assert "script-src 'self'" in front.headers["content-security-policy"]
    assert front.headers["cache-control"] == "no-cache"
    assert style.text == "h1 {}"


async def test_nothing_beside_it_is_served(written: Callable[[str, str], Path]) -> None:
    manual = written("index.html", "<h1>Manual</h1>")
    (manual.parent / "secret.txt").write_text("secret")
    async with serving(app_with(manual)) as browser:
        for path in ("none.html", "../secret.txt", "..%2fsecret.txt", "%2e%2e/secret.txt"):
            assert (await browser.get(f"/manual/{path}")).status_code == 404
