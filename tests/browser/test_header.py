"""The header of a phone says in full which site or tracker is shown, in every language."""

from dataclasses import replace

from app.web.languages.known import LANGUAGES
from tests.browser.conftest import Opened, Plant
from tests.browser.test_languages_fit import ON_ANOTHER

SITE = "Konya Karapınar Solar Park 2"
TRACKER = "Northwest corner mast"
PATHS = ("/", "/simulate", "/trackers/T1", "/trackers/T1/commissioning/homing", "/trackers/T1/protections")
CUT = """() => {
  const header = document.querySelector(".header").getBoundingClientRect();
  const shown = [...document.querySelectorAll(".header-where > *, .header-who > b, .header-clock > *")];
  return shown.filter((one) => {
    const box = one.getBoundingClientRect();
    const across = box.left >= 0 && box.right <= innerWidth;
    const within = across && box.top >= header.top && box.bottom <= header.bottom;
    return !within || one.scrollWidth > one.clientWidth + 1 || one.scrollHeight > one.clientHeight + 1;
  }).map((one) => one.textContent);
}"""
BROKEN = """() => [".header-where b", ".header-who b"].flatMap((name) => {
  const text = document.querySelector(name).firstChild;
  return [...text.data.matchAll(/[^\\s-]+/g)].filter((word) => {
    const range = document.createRange();
    range.setStart(text, word.index);
    range.setEnd(text, word.index + word[0].length);
    return range.getClientRects().length > 1;
  }).map((word) => word[0]);
})"""
OVER = """() => {
  const parts = [...document.querySelectorAll(".header > *")].filter((one) => one.checkVisibility());
  const boxes = parts.map((one) => one.getBoundingClientRect());
  return boxes.flatMap((one, index) => boxes.slice(index + 1).map((two, more) => {
    const across = Math.min(one.right, two.right) - Math.max(one.left, two.left);
    const down = Math.min(one.bottom, two.bottom) - Math.max(one.top, two.top);
    return across > 0.5 && down > 0.5 ? [parts[index].className, parts[index + 1 + more].className] : null;
  })).filter(Boolean);
}"""


def name_them(plant: Plant) -> None:
    plant.machine.site = replace(plant.machine.site, name=SITE)
    tracker = plant.machine.trackers["T1"]
    tracker.config = replace(tracker.config, name=TRACKER)


def test_names_in_the_header_of_a_phone_are_whole(plant: Plant, opened: Opened) -> None:
    name_them(plant)
    page = opened("/", "phone")
    for language in LANGUAGES:
        page.context.add_cookies([{"name": "language", "value": language, "url": plant.url}])
        for path in PATHS:
            page.goto(plant.url + path)
            name = page.locator(".header-where b").inner_text()
            assert (TRACKER if "T1" in path else SITE) in name
            seen = f"{path} in {language}"
            assert page.evaluate(CUT) == [], seen
            assert language == "zh_Hans" or page.evaluate(BROKEN) == [], seen
            assert page.evaluate(OVER) == [], seen
            assert page.evaluate(ON_ANOTHER) == [], seen
