"""The pages of figures: their pictures say what they show, and they print in black."""

import re
from typing import Any

from playwright.sync_api import Page

PICTURES = {"accuracy": 2, "step-program": 2, "study": 4, "papers": 0}
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
NOT_PRINTED = """[...document.querySelectorAll('.footer, .rail, .header, .key')]
  .filter(e => e.offsetHeight).length"""
NARROWEST = """Math.min(...[...document.querySelectorAll('td')].filter(e => e.textContent.length > 3)
  .map(e => e.getBoundingClientRect().width))"""
LEAST_PX = 30


def faults_of_figures(page: Page, name: str) -> list[str]:
    """Return what is wrong with the pictures and tables of a page of figures, on the screen and on paper."""
    pictures = page.evaluate(TOLD)
    found = [] if len(pictures) == PICTURES[name] else [f"{len(pictures)} pictures"]
    if page.evaluate(NARROWEST) < LEAST_PX:
        found.append("a column is too narrow")
    for one in pictures:
        said = len(one["title"]) > 10 and UNITS.search(one["upwards"]) and UNITS.search(one["across"])
        if not said or len(one["key"]) < 2 or not all(one["key"]):
            found.append(f"a picture without title, units, or key: {one}")
    if page.locator("[data-print]:visible").count() != (1 if name == "study" else 0):
        found.append("the key that prints")
    page.emulate_media(media="print")
    found += _faults_on_paper(page, page.evaluate(TOLD))
    page.emulate_media(media="screen")
    return found


def _faults_on_paper(page: Page, pictures: list[dict[str, Any]]) -> list[str]:
    found = ["the frame is printed"] if page.evaluate(NOT_PRINTED) else []
    for one in pictures:
        told_apart = one["strokes"] == ["rgb(0, 0, 0)"] and one["looks"] == len(one["key"])
        if one["lines"] and not told_apart:
            found.append(f"curves on paper are not black, or not told apart: {one}")
    return found
