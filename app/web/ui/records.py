"""Signed commissioning records: the list, one of them, two side by side."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.web.contexts import Link
from app.web.deps import ReaderDep
from app.web.late_routes import page_router
from app.web.record_contexts import ComparePage, RecordsPage, SignedRecordPage
from app.web.record_document import Difference, differences, read_document
from app.web.record_orders import signed_record
from app.web.record_words import told_heading, told_name, told_sections, told_title, told_value
from app.web.ui.frame import site_frame
from app.web.ui.render import page

router = page_router(prefix="/records")
TWO = "Choose two records to compare."
GIVEN = ("Signatures", "Photos")
BACK = Link("Records", "/records")


@router.get("")
def records(request: Request, reader: ReaderDep) -> Response:
    """List every signed record, newest first."""
    frame = site_frame(request, "Commissioning records")
    return page(request, RecordsPage(frame, tuple(reader.signed_records())))


@router.get("/compare")
def compare(
    request: Request,
    reader: ReaderDep,
    pick: Annotated[list[int] | None, Query(max_length=20)] = None,
    everything: Annotated[str, Query(max_length=8)] = "",
) -> Response:
    """Show two records side by side, what differs marked."""
    chosen = sorted(set(pick or ()))
    if len(chosen) != 2:
        frame = site_frame(request, "Commissioning records")
        return page(request, RecordsPage(frame, tuple(reader.signed_records()), TWO), status=422)
    first, second = (signed_record(reader, number) for number in chosen)
    lines = differences(read_document(first), read_document(second))
    differing = [line for line in lines if line.differs]
    context = ComparePage(
        frame=site_frame(request, "Two records compared", back=BACK),
        first=first.head,
        second=second.head,
        lines=tuple(map(_told, lines if everything else differing)),
        differing=len(differing),
        only_differences=not everything,
    )
    return page(request, context)


@router.get("/{number}")
def record(request: Request, number: int, reader: ReaderDep) -> Response:
    """Show one signed record."""
    signed = signed_record(reader, number)
    read = read_document(signed)
    context = SignedRecordPage(
        frame=site_frame(request, f"Record {number}", back=BACK),
        head=signed.head,
        read=read,
        title=told_title(read.title),
        sections=tuple(
            zip((heading for heading, _ in read.sections), told_sections(read.sections), strict=True)
        ),
        photos=tuple(reader.photos_of(number)),
        signatures=read.signatures,
    )
    return page(request, context)


def _told(line: Difference) -> Difference:
    """Return a line in the language of the request; who signed and what a photo shows is left alone."""
    heading, name = told_heading(line.section), told_name(line.name)
    if line.section in GIVEN:
        return Difference(heading, name, line.first, line.second)
    return Difference(heading, name, told_value(line.name, line.first), told_value(line.name, line.second))
