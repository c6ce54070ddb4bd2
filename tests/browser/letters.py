"""Which letters of an open page are not drawn by the fonts that the panel brings."""

from playwright.sync_api import CDPSession, Page

from tests.browser.layout import LOOKS

WRITTEN = (LOOKS / "letters.js").read_text()
OURS = ("Heliopanel", '"Heliopanel')
SAY = """([letters, fonts]) => {
  const said = document.createElement('p');
  Object.assign(said, { id: 'every-letter', lang: '', textContent: letters });
  said.style.fontFamily = fonts;
  document.body.append(said);
}"""
FORGET = "document.getElementById('every-letter').remove()"


def foreign(page: Page) -> list[str]:
    """Return, in words, what a page writes with fonts of the computer."""
    written: dict[str, str] = page.evaluate(WRITTEN)
    assert written, "the page writes something"
    found = []
    for fonts, letters in written.items():
        found += undrawn(page, letters, fonts) if fonts.startswith(OURS) else [f"{letters} in {fonts}"]
    return found


def undrawn(page: Page, letters: str, fonts: str = "") -> list[str]:
    """Return those of the letters that our fonts, or these of them, do not have."""
    session = page.context.new_cdp_session(page)
    session.send("DOM.enable")
    session.send("CSS.enable")
    if not _others(page, session, letters, fonts):
        return []
    return [f"{one} (U+{ord(one):04X})" for one in letters if _others(page, session, one, fonts)]


def _others(page: Page, session: CDPSession, letters: str, fonts: str) -> list[str]:
    """Return the fonts that draw these letters and are not loaded from the panel."""
    page.evaluate(SAY, [letters, fonts])
    page.evaluate("document.fonts.ready.then(() => null)")
    root = session.send("DOM.getDocument")["root"]["nodeId"]
    node = session.send("DOM.querySelector", {"nodeId": root, "selector": "#every-letter"})
    drawn = session.send("CSS.getPlatformFontsForNode", node)["fonts"]
    page.evaluate(FORGET)
    assert drawn, "something is drawn"
    return [font["familyName"] for font in drawn if not font["isCustomFont"]]
