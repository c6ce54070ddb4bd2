"""The commissioning record as a PDF on A4; loaded late, as what draws it weighs 40 MB."""

import re
from collections.abc import Iterator
from io import BytesIO

from fpdf import FPDF

from app.base.own import own_folder
from app.web.features.records.record_files import Paper, Row
from app.web.features.records.record_words import PAGE, own
from app.web.features.records.signatures import HEIGHT, WIDTH, Signature
from app.web.languages import said

FONT = "DejaVu"
FONTS = own_folder("static") / "vendor" / "dejavu" / "2.37.3"
WIDE_FONT = "Droid"
WIDE_FONTS = own_folder("static") / "vendor" / "droid" / "6.0.1r16-1.1"
WIDE = re.compile("[\u2e80-\u9fff\uf900-\ufaff\ufe30-\ufe4f\uff00-\uffef\U00020000-\U0003ffff]")
"""Letters that the first font has not: Chinese and Japanese, and their signs."""
BREAKS = re.compile("(?<=[\u2e80-\u9fff\uff00-\uffef])(?=[\u3041-\u9fff])")
"""Where a line of Chinese may end: behind a letter or sign, not before a sign."""
SIGNED_MM = (70.0, 21.0)
PHOTO_MM = (82.0, 66.0)


def printed(paper: Paper, heads: tuple[str, ...]) -> bytes:
    """Return a record as a PDF: every section a table, photos, and signatures or lines to sign on."""
    pdf = _Sheets(paper, heads)
    pdf.set_creation_date(paper.at)
    pdf.heading()
    for heading, rows in paper.sections:
        pdf.section(said(heading), rows)
    pdf.photos()
    pdf.signatures()
    return bytes(pdf.output())


class _Sheets(FPDF):
    """A4 with the project's font, which has the letters of people's names, and page numbers."""

    def __init__(self, paper: Paper, heads: tuple[str, ...]) -> None:
        super().__init__(format="A4")
        self._paper, self._heads = paper, heads
        self.set_title(said(paper.title))
        self.add_font(FONT, "", FONTS / "DejaVuSans.ttf")
        self.add_font(FONT, "B", FONTS / "DejaVuSans-Bold.ttf")
        if any(map(WIDE.search, _texts(paper, heads))):
            self.add_font(WIDE_FONT, "", WIDE_FONTS / "DroidSansFallbackFull.ttf")
            self.set_fallback_fonts([WIDE_FONT], exact_match=False)
        self.set_margins(18, 18)
        self.set_auto_page_break(auto=True, margin=20)
        self.add_page()

    def heading(self) -> None:
        """Write the title of the paper, its number and its hash."""
        self._letters("B", 15)
        self._lines(8, said(self._paper.title))
        self._letters("", 8.5)
        self._lines(5, "\n".join(self._heads))

    def section(self, heading: str, rows: tuple[Row, ...]) -> None:
        """Write one section as a table."""
        self._heading(heading)
        with self.table(
            col_widths=(3, 5),
            first_row_as_headings=False,
            borders_layout="HORIZONTAL_LINES",
            line_height=5,
            text_align="LEFT",
        ) as table:
            for name, value in rows:
                row = table.row()
                row.cell(_breakable(said(name)))
                row.cell(_breakable(said(value)))

    def photos(self) -> None:
        """Set the photos side by side, two in a row, each above what it shows."""
        if not self._paper.photos:
            return
        if self.will_page_break(PHOTO_MM[1] + 15):
            self.add_page()
        self._heading(said(own("Photos")))
        for place, photo in enumerate(self._paper.photos):
            if place % 2 == 0 and self.will_page_break(PHOTO_MM[1]):
                self.add_page()
            left, top = self.l_margin + (place % 2) * (PHOTO_MM[0] + 8), self.get_y()
            self.image(
                BytesIO(photo.content), left, top, PHOTO_MM[0], PHOTO_MM[1] - 8, keep_aspect_ratio=True
            )
            self.set_xy(left, top + PHOTO_MM[1] - 7)
            self.cell(PHOTO_MM[0], 5, photo.caption)
            last_in_row = place % 2 == 1 or place == len(self._paper.photos) - 1
            self.set_xy(self.l_margin, top + PHOTO_MM[1] if last_in_row else top)

    def signatures(self) -> None:
        """Draw what was signed, above a line with the name; an empty line is for a pen."""
        if self.will_page_break(SIGNED_MM[1] + 25):
            self.add_page()
        self._heading(said(own("Signatures")))
        top = self.get_y()
        for place, one in enumerate(self._paper.signatures):
            left = self.l_margin + place * (SIGNED_MM[0] + 20)
            self._draw(one, left, top)
            self.line(left, top + SIGNED_MM[1], left + SIGNED_MM[0], top + SIGNED_MM[1])
            self.set_xy(left, top + SIGNED_MM[1] + 1)
            self.multi_cell(SIGNED_MM[0], 5, f"{said(one.words)}\n{one.name}".strip(), align="L")

    def _draw(self, one: Signature, left: float, top: float) -> None:
        self.set_line_width(0.4)
        for (x1, y1), (x2, y2) in one.lines:
            across, down = SIGNED_MM[0] / WIDTH, SIGNED_MM[1] / HEIGHT
            self.line(left + x1 * across, top + y1 * down, left + x2 * across, top + y2 * down)
        self.set_line_width(0.2)

    def _heading(self, heading: str) -> None:
        self.ln(4)
        self._letters("B", 11)
        self._lines(7, heading)
        self._letters("", 8.5)

    def _lines(self, height: float, text: str) -> None:
        self.multi_cell(0, height, _breakable(text), align="L", new_x="LMARGIN", new_y="NEXT")

    def _letters(self, style: str, points: float) -> None:
        """Choose the letters for what follows.

        The library would choose them with the next text, and forget them behind letters of the second font.
        """
        self.set_font(FONT, style, points)
        self.text(self.l_margin, self.t_margin, " ")

    def header(self) -> None:
        """Choose the letters anew on a new page, which begins without."""
        if self.font_family:
            self.text(self.l_margin, self.t_margin, " ")

    def footer(self) -> None:
        """Number the pages, and say which paper they are of."""
        self.set_y(-14)
        self._letters("", 8)
        which = (self._paper.title, self._paper.mark, own(PAGE, number=self.page_no()))
        self.cell(0, 6, " - ".join(map(said, which)), align="C")


def _texts(paper: Paper, heads: tuple[str, ...]) -> Iterator[str]:
    """Return everything that is written on a paper."""
    yield from (said(paper.title), *heads, said(own("Signatures")))
    for heading, rows in paper.sections:
        yield said(heading)
        for row in rows:
            yield from map(said, row)
    yield from (one.caption for one in paper.photos)
    yield from (one.name for one in paper.signatures)


def _breakable(text: str) -> str:
    """Return a text whose lines may end between Chinese letters, which have no spaces between them."""
    return BREAKS.sub("\u200b", text)
