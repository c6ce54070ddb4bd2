"""What the five papers print, and what comes out when it is computed."""

from typing import Annotated, Self

from fastapi import Query

from app.base.permission import Permission
from app.research.library import papers
from app.research.result import Basis, Erratum, Figure, Gap, Group, Paper, Standing
from app.web.api.base import NOT_FOUND, TOO_MANY, Output, Page, api_router, whole
from app.web.http.needs import needs
from app.web.shell.deps import PanelDep

router = api_router(prefix="/papers", tags=["papers"])


class FigureReport(Output):
    """A published value, ours and the difference; null where nothing is published."""

    name: str
    unit: str
    published: float | None
    ours: float
    difference: float | None
    standing: Standing
    basis: Basis
    remark: str

    @classmethod
    def of(cls, figure: Figure) -> Self:
        """Return a figure as the API tells it."""
        return cls(
            name=figure.name,
            unit=figure.unit,
            published=figure.published,
            ours=figure.ours,
            difference=figure.difference,
            standing=figure.standing,
            basis=figure.basis,
            remark=figure.remark,
        )


class GroupReport(Output):
    """A table or figure of a paper."""

    title: str
    note: str
    figures: list[FigureReport]

    @classmethod
    def of(cls, group: Group) -> Self:
        """Return a group as the API tells it."""
        figures = [FigureReport.of(figure) for figure in group.figures]
        return cls(title=group.title, note=group.note, figures=figures)


class ErratumReport(Output):
    """A misprint: where, what is printed, what it must be, and its effect; whether that could be measured."""

    where: str
    printed: str
    right: str
    effect: str
    measured: bool

    @classmethod
    def of(cls, one: Erratum) -> Self:
        """Return an erratum as the API tells it."""
        return cls(
            where=one.where,
            printed=one.printed,
            right=one.right,
            effect=one.effect.text,
            measured=one.effect.measured,
        )


class PaperReport(Output):
    """A paper: its figures, its errata with their effect, and what cannot be computed."""

    key: str
    name: str
    citation: str
    agreeing: int
    published: int
    groups: list[GroupReport]
    errata: list[ErratumReport]
    gaps: list[Gap]

    @classmethod
    def of(cls, paper: Paper) -> Self:
        """Return a paper as the API tells it."""
        return cls(
            key=paper.key,
            name=paper.name,
            citation=paper.citation,
            agreeing=paper.agreeing,
            published=paper.published,
            groups=[GroupReport.of(group) for group in paper.groups],
            errata=[ErratumReport.of(one) for one in paper.errata],
            gaps=list(paper.gaps),
        )


@router.get("", summary="The papers beside our results", responses=NOT_FOUND | TOO_MANY)
@needs(Permission.READ)
async def read_papers(
    panel: PanelDep,
    paper: Annotated[list[str] | None, Query(description="Keys of papers; left out: all five.")] = None,
) -> Page[PaperReport]:
    """Return every published figure that can be computed, errata, and what cannot be had."""
    found = await panel.simulations.work_out(papers, tuple(paper or ()))
    return whole(PaperReport.of(one) for one in found)
