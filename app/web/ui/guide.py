"""The documents inside the panel: the guide and what it refers to, and the search over everything."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from app.web import guide as documents
from app.web.deps import panel
from app.web.errors import NotFound
from app.web.guide_contexts import GuidePage, SearchPage
from app.web.late_routes import page_router
from app.web.ui.frame import site_frame
from app.web.ui.render import page
from app.web.ui.search import Found, found

router = page_router()


@router.get("/guide")
def operators_guide(request: Request) -> Response:
    """Show the operator's guide."""
    return _show(request, documents.GUIDE)


@router.get("/guide/{document}")
def document(request: Request, document: str) -> Response:
    """Show one of the documents."""
    return _show(request, document)


@router.get("/guide/pictures/{name}")
def picture(name: str) -> Response:
    """Return a picture of the documents."""
    path = documents.picture(name)
    if path is None:
        raise NotFound(f"There is no picture {name} in the documents.")
    return FileResponse(path, media_type="image/png")


@router.get("/search")
def search(request: Request, q: Annotated[str, Query(max_length=200)] = "") -> Response:
    """Show pages, settings, alarms and sections of the documents that have all the words, or come nearest."""
    words = q.strip()
    outcome = found(request, words) if words else Found(())
    return page(request, SearchPage(site_frame(request, "Search"), words, outcome.hits, outcome.is_near))


def _show(request: Request, name: str) -> Response:
    if name not in documents.TITLES:
        raise NotFound(f"There is no document {name}; see the list of documents in the guide.")
    title = documents.TITLES[name]
    context = GuidePage(
        frame=site_frame(request, title),
        name=name,
        title=title,
        sections=documents.sections(name),
        titles=documents.TITLES,
        is_foreign=documents.is_foreign(name),
        has_manual=panel(request).manual.is_built,
    )
    return page(request, context)
