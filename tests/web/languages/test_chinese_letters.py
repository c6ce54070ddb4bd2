"""Fonts of Chinese pages have every letter the catalogue uses; `vendor.py check` says which is missing."""

import importlib.util
import json
from pathlib import Path
from types import ModuleType

import pytest

from app.web.languages.catalogue import catalogue_of
from app.web.languages.known import LANGUAGES

VENDOR = Path(__file__).resolve().parents[3] / "static" / "vendor" / "vendor.py"
PAGES = "noto/5.3.0/noto-sans-sc-pages-400.woff2"


@pytest.fixture(scope="module")
def vendor() -> ModuleType:
    spec = importlib.util.spec_from_file_location("vendor", VENDOR)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_nothing_that_chinese_pages_say_is_missing(vendor: ModuleType) -> None:
    manifest = json.loads(vendor.MANIFEST.read_text())
    letters = set(manifest["noto"]["letters"][PAGES])
    said = set("".join(catalogue_of("zh_Hans").texts.values()))
    points = set("".join(LANGUAGES["zh_Hans"].compass))
    assert {letter for letter in said | points if letter >= vendor.FIRST_OF_CHINESE} <= letters
    assert vendor.uncut(manifest) == []


def test_a_letter_that_was_not_cut_is_told(vendor: ModuleType) -> None:
    manifest = json.loads(vendor.MANIFEST.read_text())
    manifest["noto"]["letters"][PAGES] = manifest["noto"]["letters"][PAGES].replace("风", "")
    assert vendor.uncut(manifest) == [
        "noto-sans-sc-pages-400.woff2 lacks 风, which pages use; run make translations."
    ]
