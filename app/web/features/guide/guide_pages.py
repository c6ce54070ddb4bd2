"""The documents inside the panel: the guide and what it refers to, and the search over everything."""

from typing import Annotated

from fastapi import Query
from starlette.requests import Request
from starlette.responses import FileResponse, Response

from app.base.message import N_, say
from app.base.permission import Permission
from app.web.features.guide import guide as documents
from app.web.features.guide.guide_contexts import GuidePage, SearchPage
from app.web.features.guide.search import Found, found
from app.web.http.errors import NotFound
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import panel
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router()


@router.get("/guide")
@needs(Permission.READ)
def operators_guide(request: Request) -> Response:
    """Show the operator's guide."""
    return _show(request, documents.GUIDE)


@router.get("/guide/{document}")
@needs(Permission.READ)
def document(request: Request, document: str) -> Response:
    """Show one of the documents."""
    return _show(request, document)


@router.get("/guide/pictures/{name}")
@needs(Permission.READ)
def picture(name: str) -> Response:
    """Return a picture of the documents."""
    path = documents.picture(name)
    if path is None:
        raise NotFound(say("There is no picture {name} in the documents.", name=name))
    return FileResponse(path, media_type="image/png")


@router.get("/search")
@needs(Permission.READ)
def search(request: Request, q: Annotated[str, Query(max_length=200)] = "") -> Response:
    """Show pages, settings, alarms and sections of the documents that have all the words, or come nearest."""
    words = q.strip()
    outcome = found(request, words) if words else Found(())
    return page(request, SearchPage(site_frame(request, N_("Search")), words, outcome.hits, outcome.is_near))


def _show(request: Request, name: str) -> Response:
    if name not in documents.TITLES:
        raise NotFound(say("There is no document {name}; see the list of documents in the guide.", name=name))
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
