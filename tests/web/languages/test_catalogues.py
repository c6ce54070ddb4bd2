"""The catalogues are true to the gaps and tags of the English texts; `make check`: they are current."""

import re
from collections import Counter
from collections.abc import Iterator
from functools import cache

import pytest
from babel.messages.catalog import Catalog, Message
from markdown_it import MarkdownIt
from markdown_it.token import Token

from app.web.languages.catalogue import DOCUMENTS
from app.web.languages.known import TRANSLATED
from app.web.translation.catalogues import identity, mo_bytes, read, renewed, take, untranslated

GAPS = re.compile(r"\{[a-z][a-z0-9_]*\}|%\([a-z_0-9]+\)[sd]")
TAGS = re.compile(r"</?[a-z][a-z0-9]*[^>]*>")
IN_PLACE = ("code_inline", "html_inline", "image", "link_open")
CEDILLA = re.compile("[şţŞŢ]")

PLURAL_FORMS = {"tr": 1, "de": 2, "es": 2, "ro": 3, "zh_Hans": 1}


@pytest.fixture(scope="module", params=TRANSLATED)
def stored(request: pytest.FixtureRequest) -> Catalog:
    return read(request.param)


def translated(catalog: Catalog) -> Iterator[tuple[Message, str, str]]:
    """Return every translated text with its English form and its form in the language."""
    for text in catalog:
        if not text.id:
            continue
        forms = text.string if isinstance(text.string, tuple) else (text.string,)
        english = text.id if isinstance(text.id, tuple) else (text.id,)
        for number, form in enumerate(forms):
            if form:
                yield text, english[-1] if number or len(forms) == 1 else english[0], form


def test_gaps_are_those_of_the_english_text(stored: Catalog) -> None:
    for text, english, form in translated(stored):
        if isinstance(text.id, tuple):
            assert set(GAPS.findall(form)) <= set(GAPS.findall(english)), form
        else:
            assert Counter(GAPS.findall(form)) == Counter(GAPS.findall(english)), form
        assert form.count("%%") == english.count("%%"), form


def test_tags_are_those_of_the_english_text(stored: Catalog) -> None:
    for _, english, form in translated(stored):
        assert Counter(TAGS.findall(form)) == Counter(TAGS.findall(english)), form


@cache
def marks(markdown: str) -> Counter[str]:
    """Return what is no word in a block: links, code, pictures, anchors, and how often it stresses."""
    children = [
        child for token in MarkdownIt("commonmark").parseInline(markdown) for child in token.children or ()
    ]
    found = Counter(child.type for child in children if child.type in ("strong_open", "em_open"))
    for child in children:
        if child.type in IN_PLACE:
            found[f"{child.attrs.get('href', '')}{child.attrs.get('src', '')} {_own(child)}"] += 1
    return found


def _own(child: Token) -> str:
    return "" if child.type == "image" else child.content


def test_blocks_of_documents_have_the_links_code_pictures_and_anchors_of_the_english_ones(
    stored: Catalog,
) -> None:
    blocks = [(english, form) for text, english, form in translated(stored) if text.context == DOCUMENTS]
    assert len(blocks) > 500
    assert [form for english, form in blocks if marks(form) != marks(english)] == []


def test_letters_are_those_of_the_language(stored: Catalog) -> None:
    wrong = [form for _, _, form in translated(stored) if CEDILLA.search(form)]
    assert str(stored.locale) == "tr" or wrong == [], "write ș and ț with a comma below"


def test_plural_forms_are_those_of_the_language(stored: Catalog) -> None:
    assert stored.num_plurals == PLURAL_FORMS[str(stored.locale)]


def test_a_translation_is_taken_by_its_identity_and_comes_back_after_a_change() -> None:
    fresh = Catalog(locale="de")
    fresh.add("Save it")
    fresh.add(("%(num)s key", "%(num)s keys"))
    lines = [
        {"id": identity(None, "Save it"), "msgstr": "Speichern"},
        {"msgid": "%(num)s key", "msgstr": ["%(num)s Taste", "%(num)s Tasten"]},
        {"id": "gone", "msgstr": "weg"},
    ]
    catalog, unknown = take(renewed(Catalog(locale="de"), fresh), lines)
    assert unknown == 1
    assert [text.string for text in catalog if text.id] == ["Speichern", ("%(num)s Taste", "%(num)s Tasten")]
    without = renewed(catalog, Catalog(locale="de"))
    assert [text.string for text in renewed(without, fresh) if text.id] == [
        "Speichern",
        ("%(num)s Taste", "%(num)s Tasten"),
    ]


def test_what_is_not_translated_is_not_compiled() -> None:
    catalog = Catalog(locale="de")
    catalog.add("Nothing yet", "")
    catalog.add(("one", "many"), ("", ""))
    assert b"Nothing yet" not in mo_bytes(catalog)
    assert b"many" not in mo_bytes(catalog)
    assert untranslated(catalog) == ["Nothing yet", ("one", "many")]
