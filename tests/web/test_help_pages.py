"""The guide inside the panel, help on pages, the search, the themes, and what a home screen needs."""

import re
from collections.abc import AsyncIterator
from dataclasses import replace
from io import BytesIO

import httpx
import pytest
from markupsafe import escape
from PIL import Image

from app.alarms.catalogue import ENTRIES
from app.sun.position import SunPosition
from app.tracker.settings.axes import Axis
from app.tracker.settings.config import TrackerConfig
from app.web.features.guide import guide, rendering
from app.web.features.setup.settings import TRACKING
from app.web.shell.help import PAGES, help_for
from app.web.shell.render import environment
from app.web.shell.setting_forms import below, field_name
from app.web.shell.themes import theme_of
from tests.fakes import FakeMachine, fake_app, serving

EXAMPLES = {
    "/trackers/[^/]+": "/trackers/T1",
    "(/orientation)?": "",
}


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app()) as one:
        yield one


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


@pytest.mark.parametrize("pattern", [pattern for pattern, _ in PAGES])
async def test_help_is_closed_on_its_page(pattern: str, client: httpx.AsyncClient) -> None:
    page = await client.get(path_of(pattern))
    found = help_for(path_of(pattern))
    assert found is not None
    assert page.status_code == 200
    assert '<details class="help no-print" id="help"><summary' in page.text
    assert escape(found.purpose[:40]) in page.text


@pytest.mark.parametrize("name", guide.TITLES)
async def test_every_document_is_a_page_whose_links_lead_somewhere(
    name: str, client: httpx.AsyncClient
) -> None:
    page = await client.get(f"/guide/{name}")
    assert page.status_code == 200
    article = page.text.split('<article class="panel guide-text"')[1].split("</article>")[0]
    known = {f"#{anchor}" for anchor in re.findall(r'id="([\w.-]+)"', page.text)}
    for href in re.findall(r'href="([^"]*)"', article):
        assert href in known or href.startswith("/guide/"), href
        if href.startswith("/guide/"):
            assert href.split("#")[0].removeprefix("/guide/") in guide.TITLES
    for source in set(re.findall(r'src="([^"]*)"', article)):
        assert (await client.get(source)).content.startswith(b"\x89PNG")


async def test_the_guide_names_every_alarm_where_links_expect_it(client: httpx.AsyncClient) -> None:
    page = (await client.get("/guide")).text
    assert [entry.code for entry in ENTRIES if f'<a id="alarm-{entry.code}">' not in page] == []


async def test_html_in_a_document_is_text_and_nothing_outside_is_served(client: httpx.AsyncClient) -> None:
    rendered = rendering.rendered("# A\n\n<b onclick=x>bold</b>\n\n<script>1</script>\n\n[x](../SECURITY.md)")
    assert "<script" not in rendered
    assert "<b " not in rendered
    assert "SECURITY" not in rendered
    for path in ("/guide/none", "/guide/pictures/none.png", "/guide/pictures/..%2f..%2fREADME.md"):
        assert (await client.get(path)).status_code == 404


@pytest.mark.parametrize(
    ("words", "kind", "title"),
    [
        ("deadband", "Setting", "T1: Deadband"),
        ("drive answer", "Alarm", "Drive does not answer"),
        ("gust", "Setting", "T1: Wind: Gust threshold"),
        ("alarms", "Page", "Alarms"),
        ("maintenance lock", "Document", "Operator&#39;s guide: Maintenance inhibit"),
    ],
)
async def test_search_finds_pages_settings_alarms_and_documents(
    words: str, kind: str, title: str, client: httpx.AsyncClient
) -> None:
    text = (await client.get("/search", params={"q": words})).text
    assert re.search(rf'<span class="chip">{kind}</span><span[^>]*><b>{re.escape(title)}</b>', text)


async def test_search_says_when_nothing_fits(client: httpx.AsyncClient) -> None:
    assert "No result contains all these words." in (await client.get("/search?q=zzyzx")).text
    assert "<script>" not in (await client.get("/search?q=<script>")).text


async def test_every_number_of_the_settings_has_its_range_and_default_below_it(
    client: httpx.AsyncClient,
) -> None:
    page = (await client.get("/trackers/T1/settings")).text
    for one in (*TRACKING, *(one for axis in Axis for one in below(TrackerConfig, axis))):
        if one.is_number:
            assert f'id="f-{field_name(one.path)}"' in page
            assert one.hint in page, one.path


@pytest.mark.parametrize(
    ("elevation_deg", "theme"), [(-3.1, "night"), (-2.9, "day"), (14.9, "day"), (15.1, "sun"), (70.0, "sun")]
)
def test_auto_goes_by_the_sun(elevation_deg: float, theme: str) -> None:
    site = FakeMachine().latest()
    assert site is not None
    shown = replace(site, sun=SunPosition(180.0, elevation_deg, elevation_deg))
    assert theme_of("auto", shown) == theme
    assert theme_of("night", shown) == "night"
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


async def test_components_stand_in_every_theme(client: httpx.AsyncClient) -> None:
    page = (await client.get("/components")).text
    assert re.findall(r'class="specimen" data-theme="(\w+)"', page) == ["day", "sun", "night"]
    assert page.count('aria-invalid="true"') == 3


@pytest.mark.parametrize("document", guide.TITLES)
def test_no_document_has_a_style_that_the_policy_of_the_pages_forbids(document: str) -> None:
    assert not [part.anchor for part in guide.sections(document) if "style=" in part.html]
