"""What must not be in a site of documents is found in it."""

import json
from pathlib import Path

import pytest

from tools.manual.links import faults
from tools.manual.site import finish

WHOLE = '<h1 id="top">A</h1><a href="#top">up</a><a href="https://doi.org/1">paper</a><img src="a.png">'


@pytest.fixture
def site(tmp_path: Path) -> Path:
    (tmp_path / "a.png").touch()
    (tmp_path / "search.json").write_text(json.dumps({"items": [{"location": "index.html#top"}]}))
    (tmp_path / "index.html").write_text(WHOLE)
    return tmp_path


def test_a_whole_site_has_no_faults(site: Path) -> None:
    assert faults(site) == []


@pytest.mark.parametrize(
    ("written", "fault"),
    [
        ('<a href="none.html">x</a>', "none.html is not there"),
        ('<a href="../outside.html">x</a>', "../outside.html is not there"),
        ('<a href="index.html#none">x</a>', "index.html#none has no such anchor"),
        ('<img src="none.png">', "none.png is not there"),
        ('<script src="https://elsewhere.example/a.js"></script>', "is loaded from elsewhere"),
        ('<link rel="stylesheet" href="//elsewhere.example/a.css">', "is loaded from elsewhere"),
        ("<script>go()</script>", "a script in the page"),
        ('<p style="color: red">', "style=color: red"),
        ('<p onclick="go()">', "onclick=go()"),
        ('<pre class="mermaid">', "mermaid"),
    ],
)
def test_a_fault_is_told(written: str, fault: str, site: Path) -> None:
    (site / "index.html").write_text(WHOLE + written)
    (found,) = faults(site)
    assert found.startswith("index.html: ")
    assert fault in found


def test_a_page_that_no_search_finds_is_told(site: Path) -> None:
    (site / "more.html").write_text("<h1>More</h1>")
    assert faults(site) == ["more.html: the search does not know it"]


def test_a_script_in_a_page_becomes_a_file(site: Path) -> None:
    (site / "assets" / "javascripts").mkdir(parents=True)
    (site / "deep").mkdir()
    page = site / "deep" / "page.html"
    page.write_text('<script>go("now")</script><td style="text-align: right;">1</td>')
    (site / "search.json").write_text(
        json.dumps({"items": [{"location": f"{n}.html"} for n in ("index", "deep/page")]})
    )
    finish(page, site)
    assert faults(site) == []
    (script,) = (site / "assets" / "javascripts").iterdir()
    assert script.read_text() == 'go("now")'
    assert f'src="../assets/javascripts/{script.name}"' in page.read_text()
    assert '<td class="number">' in page.read_text()
