"""Signed commissioning records: the list, one of them, two side by side."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import Response

from app.base.message import N_, say
from app.base.permission import Permission
from app.web.features.records.record_contexts import ComparePage, RecordsPage, SignedRecordPage
from app.web.features.records.record_document import differences, read_document
from app.web.features.records.record_orders import signed_record
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.contexts import Link
from app.web.shell.deps import ReaderDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/records")
TWO = N_("Choose two records to compare.")
BACK = Link(N_("Records"), "/records")


@router.get("")
@needs(Permission.READ)
def records(request: Request, reader: ReaderDep) -> Response:
    """List every signed record, newest first."""
    frame = site_frame(request, N_("Commissioning records"))
    return page(request, RecordsPage(frame, tuple(reader.signed_records())))


@router.get("/compare")
@needs(Permission.READ)
def compare(
    request: Request,
    reader: ReaderDep,
    pick: Annotated[list[int] | None, Query(max_length=20)] = None,
    everything: Annotated[str, Query(max_length=8)] = "",
) -> Response:
    """Show two records side by side, what differs marked."""
    chosen = sorted(set(pick or ()))
    if len(chosen) != 2:
        frame = site_frame(request, N_("Commissioning records"))
        return page(request, RecordsPage(frame, tuple(reader.signed_records()), TWO), status=422)
    first, second = (signed_record(reader, number) for number in chosen)
    lines = differences(read_document(first), read_document(second))
    differing = [line for line in lines if line.differs]
    context = ComparePage(
        frame=site_frame(request, N_("Two records compared"), back=BACK),
        first=first.head,
        second=second.head,
        lines=tuple(lines if everything else differing),
        differing=len(differing),
        only_differences=not everything,
    )
    return page(request, context)


@router.get("/{number}")
@needs(Permission.READ)
def record(request: Request, number: int, reader: ReaderDep) -> Response:
    """Show one signed record."""
    signed = signed_record(reader, number)
    read = read_document(signed)
    context = SignedRecordPage(
        frame=site_frame(request, say("Record {number}", number=number), back=BACK),
        head=signed.head,
        read=read,
        photos=tuple(reader.photos_of(number)),
        signatures=read.signatures,
    )
    return page(request, context)
