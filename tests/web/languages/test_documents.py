"""Documents in the reader's language: the same sections, anchors, links, pictures; found by their words."""

import re
from collections.abc import AsyncIterator, Iterator
from contextlib import contextmanager

import httpx
import pytest

from app.web.features.guide import guide
from app.web.features.guide.search_index import index
from app.web.features.guide.search_score import plain, score
from app.web.languages import CATALOGUE
from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import ENGLISH, LANGUAGES, TRANSLATED
from tests.fakes import FakeMachine, FakeReader, fake_app, serving

MOST_BYTES = 40_000
"""The document itself as it travels; what all pages share comes to it, and 150 kB are for the whole."""
LINKS = re.compile(r'(?:href|src|id)="([^"]*)"')


@contextmanager
def speaking(code: str) -> Iterator[None]:
    """Answer in a language."""
    before = CATALOGUE.set(catalogue_of(code))
    yield
    CATALOGUE.reset(before)


def sections(document: str, code: str) -> tuple[guide.GuideSection, ...]:
    with speaking(code):
        return guide.sections(document)


@pytest.fixture
async def client() -> AsyncIterator[httpx.AsyncClient]:
    async with serving(fake_app(FakeMachine(), FakeReader())) as browser:
        yield browser


@pytest.mark.parametrize("code", TRANSLATED)
@pytest.mark.parametrize("document", guide.SPOKEN)
def test_a_document_has_every_section_with_the_english_anchor(document: str, code: str) -> None:
    spoken, english = sections(document, code), sections(document, ENGLISH.code)
    assert [(one.anchor, one.level) for one in spoken] == [(one.anchor, one.level) for one in english]
    assert [sorted(LINKS.findall(one.html)) for one in spoken] == [
        sorted(LINKS.findall(one.html)) for one in english
    ]
    assert sum(one.html != other.html for one, other in zip(spoken, english, strict=True)) == len(english)


@pytest.mark.parametrize("code", LANGUAGES)
async def test_the_guide_is_as_light_in_every_language(code: str, client: httpx.AsyncClient) -> None:
    answer = await client.get("/guide", headers={"Cookie": f"language={code}", "Accept-Encoding": "gzip"})
    assert f'<html lang="{LANGUAGES[code].tag}"' in answer.text
    assert answer.num_bytes_downloaded < MOST_BYTES


@pytest.mark.parametrize("name", [name for name in guide.TITLES if name not in guide.SPOKEN])
async def test_a_document_that_is_not_translated_says_so(name: str, client: httpx.AsyncClient) -> None:
    note = catalogue_of("es").gettext("This document is available in English only.")
    page = (await client.get(f"/guide/{name}", headers={"Accept-Language": "es"})).text
    assert note != "This document is available in English only."
    assert note in page
    assert '<article class="panel guide-text" lang="en" translate="no">' in page
    assert "in English only" not in (await client.get(f"/guide/{name}")).text


@pytest.mark.parametrize("code", TRANSLATED)
def test_words_of_the_reader_and_english_ones_find_a_section(code: str) -> None:
    with speaking(code):
        english, spoken = guide.sections("glossary")[0].title, catalogue_of(code).block("watchdog")
        for words in (spoken, "Watchdog", english.upper()):
            needles = plain(words).split()
            hits = {entry.href for entry, known in index() if score(known, needles)}
            assert "/guide/glossary#glossary" in hits, words
