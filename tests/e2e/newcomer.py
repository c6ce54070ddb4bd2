"""A person with one finger who sees the panel for the first time and reads what stands on a key."""

import os
import re
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.e2e.chromium import PAGE_READY
from tests.e2e.first_hour import NOTES

DOCS = Path(__file__).resolve().parents[2] / "docs"
WRITES_DOCS = os.environ.get("HELIOPANEL_DOCS") == "1"
ASIDE = "> "
"""Begins what is said to the reader and not done; the page has it without this."""
COLOURS = 64
"""Enough for a page of the panel; a picture of it takes a third of the space then."""


@dataclass
class Part:
    """One heading of what is told: what was done, in order, and the pictures taken."""

    title: str
    told: list[str] = field(default_factory=list)


@dataclass
class Newcomer:
    """Finds keys and fields by their visible words alone; counts taps and tells them."""

    page: Page
    parts: list[Part] = field(default_factory=list)
    taps: int = 0

    def begin(self, title: str) -> None:
        """Start a new heading."""
        self.parts.append(Part(title))

    def tell(self, words: str) -> None:
        """Write down one more thing that was done or seen."""
        self.parts[-1].told.append(words)

    def note(self, name: str) -> None:
        """Say why the next step is there; the reader is told, and nothing is done."""
        self.tell(f"{ASIDE}{NOTES[name]}")

    def tap(self, thing: Locator, words: str) -> None:
        """Tap what can be tapped."""
        expect(thing).to_be_enabled()
        thing.click()
        self.taps += 1
        self.tell(f"Tap *{words}*.")

    def key(self, words: str) -> None:
        """Tap the first key with these words."""
        self.tap(self.page.get_by_role("button", name=words).first, words)

    def hold(self, words: str) -> None:
        """Hold the first key with these words for as long as it asks for."""
        key = self.page.get_by_role("button", name=words).first
        key.scroll_into_view_if_needed()
        key.hover()
        with self.page.expect_request(lambda asked: asked.method == "POST"):
            self.page.mouse.down()
        self.page.mouse.up()
        self.taps += 1
        self.tell(f"Hold *{words}* for 2 s.")

    def link(self, words: str) -> None:
        """Tap the first link with these words."""
        self.tap(self.page.get_by_role("link", name=words).first, words)

    def unfold(self, words: str) -> None:
        """Tap what opens a list with these words."""
        self.tap(self.page.locator("summary", has_text=words).first, words)

    def choose(self, words: str) -> None:
        """Tap one of several choices."""
        self.page.get_by_role("radio", name=words).check()
        self.taps += 1
        self.tell(f"Tap *{words}*.")

    def write(self, label: str, text: str) -> None:
        """Tap a field and type into it."""
        entry = self.page.get_by_label(label, exact=True)
        entry.click()
        self.taps += 1
        entry.fill(text)
        self.tell(f"Tap *{label}* and type `{text}`.")

    def draw(self, pad: Locator) -> None:
        """Draw a signature with one stroke."""
        pad.scroll_into_view_if_needed()
        box = pad.bounding_box()
        assert box is not None
        left, middle = box["x"] + 40, box["y"] + box["height"] / 2
        self.page.mouse.move(left, middle)
        self.page.mouse.down()
        for step, rise in enumerate((-30, 25, -20, 30, -10, 15, 0), start=1):
            self.page.mouse.move(left + step * 35, middle + rise, steps=4)
        self.page.mouse.up()
        self.taps += 1
        self.tell("Draw the signature.")

    def sees(self, heading: str) -> None:
        """Read the heading of a page that has come and is live."""
        expect(self.page.get_by_role("heading", level=1)).to_contain_text(heading)
        self.page.wait_for_selector(PAGE_READY)

    def picture(self, name: str, says: str) -> None:
        """Photograph what is seen, for the documents."""
        self.tell(f"![{says}](../pictures/first-{name}.png)")
        if WRITES_DOCS:
            taken = Image.open(BytesIO(self.page.screenshot())).convert("RGB")
            taken.quantize(COLOURS).save(DOCS / "pictures" / f"first-{name}.png", optimize=True)

    def story(self) -> str:
        """Return what was done as a page of the documents."""
        lines = []
        for part in self.parts:
            lines += ["", f"## {part.title}", ""]
            number = 0
            for words in part.told:
                if words.startswith(("![", ASIDE)):
                    lines += ["", words.removeprefix(ASIDE), ""]
                else:
                    number += 1
                    lines.append(f"{number}. {words}")
        return re.sub(r"\n{3,}", "\n\n", "\n".join(lines)).strip() + "\n"
