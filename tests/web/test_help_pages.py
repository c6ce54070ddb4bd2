"""The guide inside the panel, help on pages, the search, the themes, and what a home screen needs."""

import re
from dataclasses import replace
from io import BytesIO

import httpx
import pytest
from markupsafe import escape
from PIL import Image

from app.alarms.catalogue import ENTRIES
from app.sun.position import SunPosition
from app.web.features.guide import guide, rendering
from app.web.shell.help import PAGES, help_for
from app.web.shell.render import environment
from app.web.shell.themes import theme_of
from tests.fakes import FakeMachine

EXAMPLES = {
    "/trackers/[^/]+": "/trackers/T1",
    "(/orientation)?": "",
}


def path_of(pattern: str) -> str:
    for written, example in EXAMPLES.items():
        pattern = pattern.replace(written, example)
    return pattern


def test_every_help_leads_to_a_section_of_the_guide_and_has_its_picture() -> None:
    anchors = {section.anchor for section in guide.sections(guide.GUIDE)}
    picture = environment().get_template("_help_pictures.html").module.help_picture  # type: ignore[attr-defined]
    for _, entry in PAGES:
        assert entry.guide in anchors, entry.title
        assert 'aria-label=""' not in picture(entry.picture), entry.title


async def test_help_is_closed_on_every_page(client: httpx.AsyncClient) -> None:
    for pattern, _ in PAGES:
        path = path_of(pattern)
        page, found = await client.get(path), help_for(path)
        assert found is not None, path
        assert page.status_code == 200, path
        assert '<details class="help no-print" id="help"><summary' in page.text, path
        assert escape(found.purpose[:40]) in page.text, path


@pytest.mark.parametrize("name", guide.TITLES)
async def test_every_document_is_a_page_whose_links_lead_somewhere(
    name: str, client: httpx.AsyncClient
) -> None:
    page = await client.get(f"/guide/{name}")
    assert page.status_code == 200
    assert not [part.anchor for part in guide.sections(name) if "style=" in part.html], (
        "the policy forbids it"
    )
    article = page.text.split('<article class="panel guide-text"')[1].split("</article>")[0]
    known = {f"#{anchor}" for anchor in re.findall(r'id="([\w.-]+)"', page.text)}
    for href in re.findall(r'href="([^"]*)"', article):
        assert href in known or href.startswith("/guide/"), href
        if href.startswith("/guide/"):
            assert href.split("#")[0].removeprefix("/guide/") in guide.TITLES
    for source in set(re.findall(r'src="([^"]*)"', article)):
        assert (await client.get(source)).content.startswith(b"\x89PNG")


async def test_html_in_a_document_is_text_and_nothing_outside_is_served(client: httpx.AsyncClient) -> None:
    rendered = rendering.rendered("# A\n\n<b onclick=x>bold</b>\n\n<script>1</script>\n\n[x](../SECURITY.md)")
    assert "<script" not in rendered
    assert "<b " not in rendered
    assert "SECURITY" not in rendered
    for path in ("/guide/none", "/guide/pictures/none.png", "/guide/pictures/..%2f..%2fREADME.md"):
        assert (await client.get(path)).status_code == 404
    page = (await client.get("/guide")).text
    unnamed = [entry.code for entry in ENTRIES if f'<a id="alarm-{entry.code}">' not in page]
    assert unnamed == [], "links lead to every alarm"


FOUND = [
    ("deadband", "Setting", "T1: Deadband"),
    ("drive answer", "Alarm", "Drive does not answer"),
    ("alarms", "Page", "Alarms"),
    ("maintenance lock", "Document", "Operator&#39;s guide: Maintenance inhibit"),
]


async def test_search_finds_pages_settings_alarms_and_documents(client: httpx.AsyncClient) -> None:
    for words, kind, title in FOUND:
        text = (await client.get("/search", params={"q": words})).text
        assert re.search(rf'<span class="chip">{kind}</span><span[^>]*><b>{re.escape(title)}</b>', text), (
            words
        )
    assert "No result contains all these words." in (await client.get("/search?q=zzyzx")).text
    assert "<script>" not in (await client.get("/search?q=<script>")).text


def test_auto_goes_by_the_sun() -> None:
    site = FakeMachine().latest()
    assert site is not None
    for elevation_deg, theme in ((-3.1, "night"), (-2.9, "day"), (14.9, "day"), (15.1, "sun")):
        seen = replace(site, sun=SunPosition(180.0, elevation_deg, elevation_deg))
        assert (theme_of("auto", seen), theme_of("night", seen)) == (theme, "night")
    assert theme_of("auto", replace(site, sun=None)) == "day"
    assert theme_of("auto", None) == "day"


async def test_the_manifest_names_icons_that_are_there(client: httpx.AsyncClient) -> None:
    answer = await client.get("/manifest.webmanifest")
    assert answer.headers["content-type"] == "application/manifest+json"
    told = answer.json()
    assert told["display"] == "standalone"
    for icon in told["icons"]:
        image = Image.open(BytesIO((await client.get(icon["src"])).content))
        assert f"{image.width}x{image.height}" == icon["sizes"]
    assert {icon["purpose"] for icon in told["icons"]} == {"any", "maskable"}
    assert '<link rel="manifest" href="/manifest.webmanifest">' in (await client.get("/")).text
