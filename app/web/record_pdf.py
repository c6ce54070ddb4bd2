"""The commissioning record as a PDF on A4; loaded late, as what draws it weighs 40 MB."""

from io import BytesIO
from pathlib import Path

from fpdf import FPDF

from app.web.record_files import Paper, Row
from app.web.signatures import HEIGHT, WIDTH, Signature

FONT = "DejaVu"
FONTS = Path(__file__).parents[2] / "static" / "vendor" / "dejavu" / "2.37.3"
SIGNED_MM = (70.0, 21.0)
PHOTO_MM = (82.0, 66.0)


def printed(paper: Paper) -> bytes:
    """Return a record as a PDF: every section a table, photos, and signatures or lines to sign on."""
    pdf = _Sheets(paper)
    pdf.set_creation_date(paper.at)
    pdf.heading()
    for heading, rows in paper.sections:
        pdf.section(heading, rows)
    pdf.photos()
    pdf.signatures()
    return bytes(pdf.output())


class _Sheets(FPDF):
    """A4 with the project's font, which has the letters of people's names, and page numbers."""

    def __init__(self, paper: Paper) -> None:
        super().__init__(format="A4")
        self._paper = paper
        self.set_title(paper.title)
        self.add_font(FONT, "", FONTS / "DejaVuSans.ttf")
        self.add_font(FONT, "B", FONTS / "DejaVuSans-Bold.ttf")
        self.set_margins(18, 18)
        self.set_auto_page_break(auto=True, margin=20)
        self.add_page()

    def heading(self) -> None:
        """Write the title of the paper, its number and its hash."""
        self.set_font(FONT, "B", 15)
        self.multi_cell(0, 8, self._paper.title, new_x="LMARGIN", new_y="NEXT")
        self.set_font(FONT, "", 8.5)
        hashed = f"SHA-256 of the JSON file: {self._paper.digest}" if self._paper.digest else ""
        self.multi_cell(0, 5, f"{self._paper.mark}\n{hashed}".strip(), new_x="LMARGIN", new_y="NEXT")

    def section(self, heading: str, rows: tuple[Row, ...]) -> None:
        """Write one section as a table."""
        self._heading(heading)
        with self.table(
            col_widths=(3, 5), first_row_as_headings=False, borders_layout="HORIZONTAL_LINES", line_height=5
        ) as table:
            for name, value in rows:
                row = table.row()
                row.cell(name)
                row.cell(value)

    def photos(self) -> None:
        """Set the photos side by side, two in a row, each above what it shows."""
        if not self._paper.photos:
            return
        if self.will_page_break(PHOTO_MM[1] + 15):
            self.add_page()
        self._heading("Photos")
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
        self._heading("Signatures")
        top = self.get_y()
        for place, one in enumerate(self._paper.signatures):
            left = self.l_margin + place * (SIGNED_MM[0] + 20)
            self._draw(one, left, top)
            self.line(left, top + SIGNED_MM[1], left + SIGNED_MM[0], top + SIGNED_MM[1])
            self.set_xy(left, top + SIGNED_MM[1] + 1)
            self.multi_cell(SIGNED_MM[0], 5, f"{one.words}\n{one.name}".strip())

    def _draw(self, one: Signature, left: float, top: float) -> None:
        self.set_line_width(0.4)
        for (x1, y1), (x2, y2) in one.lines:
            across, down = SIGNED_MM[0] / WIDTH, SIGNED_MM[1] / HEIGHT
            self.line(left + x1 * across, top + y1 * down, left + x2 * across, top + y2 * down)
        self.set_line_width(0.2)

    def _heading(self, heading: str) -> None:
        self.ln(4)
        self.set_font(FONT, "B", 11)
        self.multi_cell(0, 7, heading, new_x="LMARGIN", new_y="NEXT")
        self.set_font(FONT, "", 8.5)

    def footer(self) -> None:
        """Number the pages, and say which paper they are of."""
        self.set_y(-14)
        self.set_font(FONT, "", 8)
        which = f"{self._paper.title} - {self._paper.mark} - page {self.page_no()}"
        self.cell(0, 6, which, align="C")
