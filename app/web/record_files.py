"""The commissioning record for printing: the same sections as HTML and as PDF."""

from collections.abc import Iterator
from dataclasses import asdict
from datetime import datetime
from enum import Enum
from html import escape
from typing import Any
from zoneinfo import ZoneInfo

from fpdf import FPDF

from app.web.record import CommissioningRecord

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
    """Return the record as a PDF on A4."""
    pdf = FPDF(format="A4")
    pdf.set_title(_latin(_title(record)))
    pdf.set_creation_date(record.written_at)
    pdf.add_page()
    _line(pdf, _title(record), style="B", size=16)
    for heading, rows in sections(record):
        pdf.ln(3)
        _line(pdf, heading, style="B", size=12)
        for name, value in rows:
            _line(pdf, f"{name}: {value}", style="", size=9)
    return bytes(pdf.output())


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


def _line(pdf: FPDF, text: str, *, style: str, size: int) -> None:
    pdf.set_font("helvetica", style, size)
    pdf.multi_cell(0, size * 0.5, _latin(text), new_x="LMARGIN", new_y="NEXT")


def _latin(text: str) -> str:
    """Return the text in the letters that the PDF's built-in font has."""
    return text.encode("latin-1", "replace").decode("latin-1")
