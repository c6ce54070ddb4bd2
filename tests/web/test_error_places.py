"""Where an error stands is said once, in errors.js; no template says it, and each reply has its place."""

import json
import re
from html.parser import HTMLParser
from pathlib import Path

import httpx
import pytest

from app.web.http.security import TOO_LARGE
from app.web.languages.script_texts import script_texts
from tests.fakes import fake_app, serving
from tests.web.forms import PageForm, every_form

ROOT = Path(__file__).resolve().parents[2]
TEMPLATES = sorted((ROOT / "templates").glob("*.html"))
HTMX = {"HX-Request": "true", "HX-Request-Type": "partial"}
FIELDS = frozenset({"input", "select", "textarea"})
VOID = frozenset({"input", "br", "hr", "img", "path", "link", "meta", "use"})


class Outline(HTMLParser):
    """The ids at the top of a fragment, every id, and how many fields it has that are seen."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.top: list[str] = []
        self.ids: set[str] = set()
        self.fields = 0
        self._depth = 0
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        name = given.get("id") or ""
        self.ids.add(name)
        self.fields += tag in FIELDS and given.get("type") != "hidden"
        if self._depth == 0:
            self.top.append(name)
        self._depth += tag not in VOID

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.ids.add(dict(attrs).get("id") or "")

    def handle_endtag(self, tag: str) -> None:
        self._depth -= tag not in VOID


def test_htmx_itself_swaps_no_error() -> None:
    frame = (ROOT / "templates" / "_frame.html").read_text()
    told = re.search(r"name=\"htmx-config\" content='([^']+)'", frame)
    assert told is not None
    assert json.loads(told[1])["noSwap"] == ["204", "304", "4xx", "5xx"]


@pytest.mark.parametrize("path", TEMPLATES, ids=lambda path: path.name)
def test_no_template_says_where_an_error_goes(path: Path) -> None:
    assert "hx-status" not in path.read_text()


def test_the_sentence_of_what_is_too_large_is_said_in_every_language() -> None:
    assert str(TOO_LARGE) in script_texts()


async def reply_of(client: httpx.AsyncClient, form: PageForm) -> httpx.Response:
    values = dict.fromkeys(form.values, "x")
    if form.method == "GET":
        return await client.get(form.action.split("?")[0], params=values, headers=HTMX)
    return await client.post(form.action, data=values, headers=HTMX)


async def test_a_form_that_comes_back_with_what_is_wrong_finds_its_place() -> None:
    found, renewed = [], 0
    async with serving(fake_app()) as client:
        forms = await every_form(client)
        pages = {page: Outline((await client.get(page)).text) for page in {form.page for form in forms}}
        for form in forms:
            reply = await reply_of(client, form)
            if reply.status_code < 400 or "text/html" not in reply.headers["content-type"]:
                continue
            if "<!doctype" in reply.text:
                continue
            outline = Outline(reply.text)
            places = [name for name in outline.top if name and name in pages[form.page].ids]
            renewed += bool(places)
            if outline.fields and not places:
                found.append(f"{form.page} {form.action}: {outline.top}")
    assert found == []
    assert renewed > 20
