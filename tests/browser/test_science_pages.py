"""The pages of figures: they fit every screen, their pictures say what they show, and they print in black."""

import asyncio
import re
import threading
from collections.abc import Iterator
from datetime import UTC, date, datetime
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page

from app.base.settings import Settings
from app.studies.compute import finished, work_out
from app.studies.folder import StudyFolder, StudyState, StudyStatus
from app.studies.light import clear_days
from app.studies.request import Span, StudyMode, StudyRequest, StudyStrategy
from app.sun.position import Location
from app.tracker.settings.config import Orientation
from app.web.main import create_app
from tests.browser.conftest import SCREENS, SIZES, Served
from tests.browser.layout import faults
from tests.browser.walking import Picture
from tests.fakes import FakeMachine, FakeReader

# pvlib 0.16 asks pandas 3.1 for a name that pandas will drop.
pytestmark = pytest.mark.filterwarnings("ignore:DatetimeIndex.dayofyear is deprecated")

STUDY_ID = "20260621T120000-0a1b2c"
PAGES = {
    "accuracy": "/accuracy?place=globe&from=2026&to=2026&samples=1000",
    "papers": "/papers?show=yes",
    "step-programs": "/studies/program?date=2026-06-21",
    "study": f"/studies/{STUDY_ID}",
}
PICTURES = {"accuracy": 2, "step-programs": 2, "study": 4}
UNITS = re.compile(r"°|degrees|W/m²|Wh|kWh|hour|hours|month|day of the year|number of steps|day$")
TOLD = """() => [...document.querySelectorAll('svg.logchart')].map(svg => {
  const words = [...svg.querySelectorAll('.lc-text')];
  const upright = words.find(e => (e.getAttribute('transform') ?? '').startsWith('rotate'));
  const lowest = Math.max(...words.map(e => Number(e.getAttribute('y'))));
  const key = svg.parentElement.querySelector('.plot-key');
  const drawn = [...svg.querySelectorAll('.lc-line')].map(e => {
    const style = getComputedStyle(e);
    return [style.stroke, `${style.strokeDasharray} ${style.strokeWidth} ${style.strokeLinecap}`];
  });
  return {
    title: svg.querySelector('.lc-title').textContent,
    upwards: upright.textContent,
    across: words.find(e => Number(e.getAttribute('y')) === lowest).textContent,
    key: key ? [...key.querySelectorAll('li')].map(e => e.textContent.trim())
             : words.filter(e => Number(e.getAttribute('x')) > 780).map(e => e.textContent),
    looks: [...new Set(drawn.map(one => one[1]))].length,
    strokes: [...new Set(drawn.map(one => one[0]))],
    lines: drawn.length,
  };
})"""


@pytest.fixture(scope="module")
def panel_url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Serve one panel for all these tests, with a study in its folder."""
    data = tmp_path_factory.mktemp("science")
    keep_study(data)
    machine = FakeMachine()
    app = create_app(Settings(data_dir=data), machine=machine, reader=FakeReader(), clock=machine.clock)
    served = Served(machine, app=app)
    thread = threading.Thread(target=lambda: asyncio.run(served.run()), daemon=True)
    thread.start()
    assert served.ready.wait(20), "the panel did not start"
    assert served.server is not None
    yield f"http://127.0.0.1:{served.server.servers[0].sockets[0].getsockname()[1]}"
    served.server.should_exit = True
    thread.join(20)
    assert not thread.is_alive(), "the panel did not stop"


def keep_study(data: Path) -> None:
    """Work out a small study and keep it as the panel does."""
    request = StudyRequest(
        "Twelve days", Location(41.28, 36.33), "Europe/Istanbul", Span.TWELVE_DAYS, date(2026, 6, 21),
        (StudyMode.AZIMUTH, StudyMode.DUAL), (StudyStrategy.CONTINUOUS,), Orientation(180.0, 48.7), 60,
    )  # fmt: skip
    days = clear_days(request)
    result = finished(request, days, work_out(request, days, lambda *_: None), 0.2)
    folder = StudyFolder(data)
    at = datetime(2026, 6, 21, 12, tzinfo=UTC)
    folder.open(StudyState(STUDY_ID, request.title, at, StudyStatus.DONE), request)
    folder.keep(STUDY_ID, result)


@pytest.fixture(scope="module", params=PAGES)
def shown(request: pytest.FixtureRequest, browser: Browser, panel_url: str) -> Iterator[tuple[str, Page]]:
    """Open each page once, worked out; nothing may be complained of in its console."""
    name = request.param
    context = browser.new_context(viewport={"width": 1280, "height": 800}, locale="en-GB")
    context.set_default_timeout(30_000)
    page = context.new_page()
    complaints: list[str] = []
    page.on("console", lambda one: complaints.append(one.text) if one.type in ("error", "warning") else None)
    page.goto(panel_url + PAGES[name])
    page.wait_for_selector("[hx-trigger=load]", state="detached")
    page.wait_for_selector("table")
    yield name, page
    context.close()
    assert complaints == []


@pytest.mark.parametrize("size", SIZES)
def test_a_page_of_figures_fits(shown: tuple[str, Page], size: str, picture: Picture) -> None:
    name, page = shown
    width, height = SIZES[size]
    page.set_viewport_size({"width": width, "height": height})
    picture(page, f"science-{name}-{size}")
    assert faults(page) == []
    narrowest = "Math.min(...[...document.querySelectorAll('td')].filter(e => e.textContent.length > 3)"
    assert page.evaluate(narrowest + ".map(e => e.getBoundingClientRect().width))") >= 30


def test_every_picture_has_a_title_axes_with_units_and_a_legend(shown: tuple[str, Page]) -> None:
    name, page = shown
    pictures = page.evaluate(TOLD)
    assert len(pictures) == PICTURES.get(name, 0)
    for picture in pictures:
        assert len(picture["title"]) > 10
        assert UNITS.search(picture["upwards"]), picture["upwards"]
        assert UNITS.search(picture["across"]), picture["across"]
        assert len(picture["key"]) >= 2
        assert all(picture["key"])


def test_on_paper_curves_are_black_and_told_apart_by_their_dashes(shown: tuple[str, Page]) -> None:
    name, page = shown
    assert page.locator("[data-print]:visible").count() == (1 if name == "study" else 0)
    page.emulate_media(media="print")
    pictures = page.evaluate(TOLD)
    seen = page.evaluate(
        "[...document.querySelectorAll('.footer, .rail, .header, .key')].filter(e => e.offsetHeight).length"
    )
    SCREENS.mkdir(parents=True, exist_ok=True)
    page.pdf(path=SCREENS / f"science-{name}.pdf", format="A4")
    page.emulate_media(media="screen")
    assert seen == 0
    for picture in pictures:
        if picture["lines"]:
            assert picture["strokes"] == ["rgb(0, 0, 0)"]
            assert picture["looks"] == len(picture["key"])
