"""The five papers: published figures beside ours, errata with their effect, and what cannot be had."""

from starlette.requests import Request
from starlette.responses import Response

from app.base.permission import Permission
from app.research.library import papers, remarks, shown
from app.research.result import Figure, Group, Paper, Standing
from app.web.features.science.science_contexts import FigureRow, GroupTable, PaperSection, PapersPage
from app.web.http.late_routes import page_router
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep
from app.web.shell.frame import site_frame
from app.web.shell.render import page

router = page_router(prefix="/papers")
LONG = 14
WORDS = {Standing.AGREES: "agrees", Standing.DIFFERS: "differs", Standing.MEASURED: ""}


@router.get("")
@needs(Permission.READ)
async def read_papers(request: Request, built: PanelDep, show: str = "") -> Response:
    """Show the five papers once they have been computed; without `show` the page asks for that by itself."""
    found = await built.simulations.work_out(papers, ()) if show else ()
    context = PapersPage(
        frame=site_frame(request, "Papers"), papers=tuple(_section(one) for one in found), load=not show
    )
    return page(request, context, block="body")


def _section(paper: Paper) -> PaperSection:
    return PaperSection(
        key=paper.key,
        name=paper.name,
        citation=paper.citation,
        summary=paper.summary,
        groups=tuple(_table(group) for group in paper.groups),
        errata=paper.errata,
        gaps=paper.gaps,
    )


def _table(group: Group) -> GroupTable:
    return GroupTable(
        title=group.title,
        note=group.note,
        folded=len(group.figures) > LONG,
        figures=tuple(_row(one) for one in group.figures),
        remarks=remarks(group),
        compared=group.published > 0,
    )


def _row(figure: Figure) -> FigureRow:
    published, ours, difference = shown(figure)
    return FigureRow(figure.name, figure.unit, published, ours, difference, WORDS[figure.standing])
