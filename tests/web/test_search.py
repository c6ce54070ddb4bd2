"""The search finds every page and every field by its name, in English and in the reader's language."""

import re

import httpx
import pytest
from fastapi.routing import APIRoute

from app.web.languages.catalogue import catalogue_of
from app.web.ui.field_search import SITE_FORMS, TRACKER_FORMS, fields_of
from tests.fakes import fake_app

HIT = re.compile(r'<a class="panel hit" href="([^"]+)"')
NO_PAGES = re.compile(
    r"^/(api|static|s|manifest|login|prove|setup|kiosk|search|components)\b|/preview$|/orientation$|\.csv$"
    r"|/day$|/list$|\.crt$|/trial$|/compare$"
)
"""Files, parts of pages, and doors that nobody looks for."""
OTHER_WORDS = ("live", "trackers", "password")


async def found(client: httpx.AsyncClient, words: str, language: str = "en") -> list[str]:
    answer = await client.get("/search", params={"q": words}, headers={"accept-language": language})
    assert answer.status_code == 200
    return HIT.findall(answer.text)


def pages() -> list[str]:
    """Return the paths of all pages that need nothing but a tracker to be opened."""
    routes = (
        route for route in fake_app().routes if isinstance(route, APIRoute) and "GET" in (route.methods or ())
    )
    paths = {route.path for route in routes if not NO_PAGES.search(route.path)}
    ready = (path.replace("{tracker_id}", "T1") for path in paths)
    return sorted(path for path in ready if "{" not in path)


async def test_every_page_is_found(client: httpx.AsyncClient) -> None:
    paths = pages()
    assert len(paths) > 30
    assert [path for path in paths if not await leads_to(client, path)] == []


async def leads_to(client: httpx.AsyncClient, path: str) -> bool:
    """Return whether a word of a page's heading or address, or one of a few others, leads to it."""
    text = (await client.get(path, follow_redirects=True)).text
    heading = re.search(r'id="heading"[^>]*>([^<]+)', text)
    words = [
        *re.findall(r"[a-z]+", path.replace("trackers/T1", "")),
        *(heading[1].split() if heading else ()),
    ]
    for word in (*words, *OTHER_WORDS):
        if path in await found(client, word):
            return True
    return False


@pytest.mark.parametrize("language", ["en", "de", "tr", "es", "ro", "zh-Hans"])
async def test_fields_of_every_form_are_found_by_their_names(
    language: str, client: httpx.AsyncClient
) -> None:
    said = catalogue_of(language.replace("-", "_")).said
    forms = [(template, path) for template, _, path in SITE_FORMS]
    forms += [(template, f"/trackers/T1{end}") for template, _, end in TRACKER_FORMS]
    for template, path in forms:
        field = fields_of(template)[0]
        hits = await found(client, said(field.label), language)
        assert any(hit.split("#")[0] == path for hit in hits), (template, field, hits)


def test_the_fields_of_a_template_are_read_with_label_and_hint() -> None:
    fields = {one.name: one for one in fields_of("show.html")}
    assert fields["minutes"].label == "In how many minutes"
    assert "0.1 to 1440" in fields["minutes"].hint
    assert {"host", "port", "baud_rate"} <= {one.name for one in fields_of("drive.html")}
