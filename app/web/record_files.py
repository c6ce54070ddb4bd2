"""The commissioning record for printing: the same sections as HTML and as PDF."""

from collections.abc import Iterator
from dataclasses import asdict
from datetime import datetime
from enum import Enum
from html import escape
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

from fpdf import FPDF

from app.tracker.drive_check import DriveCheck
from app.tracker.proof_states import ProofState
from app.web.record import CommissioningRecord

FONT = "DejaVu"
FONTS = Path(__file__).parents[2] / "static" / "vendor" / "dejavu" / "2.37.3"
Section = tuple[str, list[tuple[str, str]]]
SIGNATURES = (("Commissioned by", ""), ("Accepted by", ""), ("Date", ""))
STATUS_WORDS = {"done": "done", "to_do": "to do", "to_be_confirmed": "to be confirmed"}


def record_html(record: CommissioningRecord) -> str:
    """Return the record as one HTML file that needs nothing else."""
    parts = [
        "<!doctype html><html lang='en'><meta charset='utf-8'>",
        f"<title>{escape(_title(record))}</title><h1>{escape(_title(record))}</h1>",
    ]
    for heading, rows in sections(record):
        lines = (
            f"<tr><th align='left'>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows
        )
        parts.append(f"<h2>{escape(heading)}</h2><table>{''.join(lines)}</table>")
    return "\n".join([*parts, "</html>"])


def record_pdf(record: CommissioningRecord) -> bytes:
    """Return the record as a PDF on A4, every section a table, with lines to sign on."""
    pdf = _Paper(_title(record))
    pdf.set_creation_date(record.written_at)
    pdf.heading()
    for heading, rows in sections(record):
        pdf.section(heading, rows)
    return bytes(pdf.output())


class _Paper(FPDF):
    """A4 with the project's font, which has the letters of people's names, and page numbers."""

    def __init__(self, title: str) -> None:
        super().__init__(format="A4")
        self._words = title
        self.set_title(title)
        self.add_font(FONT, "", FONTS / "DejaVuSans.ttf")
        self.add_font(FONT, "B", FONTS / "DejaVuSans-Bold.ttf")
        self.set_margins(18, 18)
        self.set_auto_page_break(auto=True, margin=20)
        self.add_page()

    def heading(self) -> None:
        """Write the title of the paper."""
        self.set_font(FONT, "B", 15)
        self.multi_cell(0, 8, self._words, new_x="LMARGIN", new_y="NEXT")

    def section(self, heading: str, rows: list[tuple[str, str]]) -> None:
        """Write one section; a row without a value is a line to sign on."""
        self.ln(4)
        self.set_font(FONT, "B", 11)
        self.multi_cell(0, 7, heading, new_x="LMARGIN", new_y="NEXT")
        self.set_font(FONT, "", 8.5)
        with self.table(
            col_widths=(3, 5), first_row_as_headings=False, borders_layout="HORIZONTAL_LINES", line_height=5
        ) as table:
            for name, value in rows:
                row = table.row(min_height=12 if not value else None)
                row.cell(name)
                row.cell(value)

    def footer(self) -> None:
        """Number the pages."""
        self.set_y(-14)
        self.set_font(FONT, "", 8)
        self.cell(0, 6, f"{self._words} - page {self.page_no()}", align="C")


def sections(record: CommissioningRecord) -> Iterator[Section]:
    """Yield every section of the record as a heading and rows of name and value."""
    zone = ZoneInfo(record.time_zone)
    yield "Written", [("at", _local(record.written_at, zone)), ("by", record.software)]
    yield "Site", [("name", record.site_name), *_fields("location", record.location, zone)]
    yield "Clock", _fields("", record.clock, zone)
    yield "Steps", [_step(step, zone) for step in record.steps]
    yield "Homing", _fields("", record.home, zone) or [("zero", "not set")]
    yield "Settings as left", [("mode", record.mode or "not selected"), *_fields("", record.tracker, zone)]
    yield "Drive", _fields("", record.drive, zone) or [("drive", "not reached yet")]
    yield "Drive, as it was read", _checked(record.check, zone)
    yield "Drive, as it was proven", [_proof(proof, zone) for proof in record.proofs]
    yield "Pointing correction", _fields("", record.pointing, zone)
    yield (
        "Now",
        [
            ("off the sun", _degrees(record.off_sun_deg)),
            ("following error", _degrees(record.following_error_deg)),
        ],
    )
    yield (
        "Events",
        [
            (_local(entry.event.at, zone), f"{entry.event.message} ({entry.event.actor})")
            for entry in record.events
        ],
    )
    yield "Signatures", list(SIGNATURES)


def _step(step: Any, zone: ZoneInfo) -> tuple[str, str]:
    when = f", {_local(step.confirmed_at, zone)} by {step.confirmed_by}" if step.confirmed_at else ""
    why = "".join(f" {reason.message}" for reason in step.reasons)
    return step.name, f"{STATUS_WORDS[step.status]}{when}.{why}"


def _proof(proof: ProofState, zone: ZoneInfo) -> tuple[str, str]:
    """Return what was proven, how it stands now, when, by whom and with which result."""
    name = " ".join(filter(None, (proof.axis or "drive", proof.kind.replace("_", " "), proof.speed)))
    when = f", {_local(proof.at, zone)} by {proof.by}" if proof.at else ""
    why = "".join(f" {reason.message}" for reason in proof.reasons)
    return name, f"{STATUS_WORDS[proof.status]}{when}. {proof.result}{why}"


def _checked(check: DriveCheck | None, zone: ZoneInfo) -> list[tuple[str, str]]:
    if check is None:
        return [("connection", "not tested since the controller was started")]
    seen = check.readings
    unsure = sorted({one.name for one in seen.registers if not one.verified})
    watchdog = "not read back" if seen.watchdog_s is None else f"{seen.watchdog_s:g} s, read back"
    return [
        ("connection", f"{seen.message} {_local(check.at, zone)} by {check.by}"),
        ("watchdog", watchdog),
        ("without commands", seen.watchdog_action or "not described"),
        ("unverified registers", ", ".join(unsure) or "none"),
    ]


def _fields(prefix: str, value: Any, zone: ZoneInfo) -> list[tuple[str, str]]:
    return [] if value is None else list(_flat(prefix, asdict(value), zone))


def _flat(prefix: str, values: dict[str, Any], zone: ZoneInfo) -> Iterator[tuple[str, str]]:
    for name, value in values.items():
        label = f"{prefix} {name}".strip()
        if isinstance(value, dict):
            yield from _flat(label, value, zone)
        elif value != ():
            yield label.replace("_", " "), _text(value, zone)


def _text(value: Any, zone: ZoneInfo) -> str:
    match value:
        case None:
            return "not known"
        case bool():
            return "yes" if value else "no"
        case datetime():
            return _local(value, zone)
        case Enum():
            return str(value.value)
        case _:
            return str(value)


def _degrees(angle: float | None) -> str:
    return "not known" if angle is None else f"{angle:.3f} degrees"


def _local(at: datetime, zone: ZoneInfo) -> str:
    return at.astimezone(zone).isoformat(sep=" ", timespec="seconds")


def _title(record: CommissioningRecord) -> str:
    return f"Commissioning record: {record.tracker.name} ({record.tracker.tracker_id})"
