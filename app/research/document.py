"""The five papers as the document that docs/explain/papers.md is."""

from collections.abc import Iterator

from app.research.library import remarks, shown
from app.research.result import Figure, Group, Paper, Standing
from app.sun.algorithms import PUBLISHED

LONG = 14
BEGIN = """\
# The five papers

What Heliopanel computes is published in five papers. This page has what each prints beside what comes out \
when it is computed, every misprint with what it costs where that can be measured, and what cannot be \
reproduced and why. The program uses the corrected equations; one step of a paper is one function, with its \
equation number beside it.

All of it is computed when it is asked for: on the page *The five papers* (reached from *Accuracy*), by \
`heliopanel papers`, and over the API by `GET /api/v1/papers`. This page is what `heliopanel papers \
--markdown` prints, and a test holds it to that. Where the effect of a misprint is a separation of two suns, \
it is the greatest against NREL SPA over 40,000 instants drawn from 2000 to 2049 and latitude -65 to 65, \
those with the sun up. Every number of an effect is computed when the page is made, from the printed form \
and the corrected one; where nothing follows that could be computed, it says "not measured". A figure is \
*fitted* where the paper leaves a value out that was chosen so that it comes out, which proves nothing.

## The algorithms

Each can be chosen for a tracker, and shows its error beside its name: greatest and rms separation from SPA, \
2000 to 2049, latitude -65 to 65, without refraction; SPA's own is its stated uncertainty. `heliopanel \
accuracy --globe` measures them anew. Beyond latitude 65 they hold too, but for `spencer-lamm`: its whole \
days are farthest off at midnight, and under the midnight sun it reaches 0.96°.
"""


def document(found: tuple[Paper, ...]) -> str:
    """Return the papers as one Markdown document."""
    lines = [BEGIN, *_algorithms(), *(line for one in found for line in _paper(one))]
    return "\n".join(lines).rstrip("\n")


def _algorithms() -> Iterator[str]:
    rows = (
        (f"`{name}`", one.title, f"{one.max_deg:g}°", f"{one.rms_deg:g}°", _source(one.source, one.doi))
        for name, one in PUBLISHED.items()
    )
    yield from _table(("name", "algorithm", "greatest", "rms", "source"), rows)


def _source(source: str, doi: str) -> str:
    return f"{source}, doi:{doi}" if doi else source


def _paper(one: Paper) -> Iterator[str]:
    yield from (f"## {one.name}", "", one.citation, "", one.summary, "")
    for group in one.groups:
        yield from _group(group)
    yield from ("### Errata", "")
    errata = ((each.where, each.printed, each.right, each.effect.text) for each in one.errata)
    yield from _table(("where", "printed", "must be", "effect"), errata)
    yield from ("### Not reproduced", "", *(f"- {gap.what}: {gap.why}" for gap in one.gaps), "")


def _group(group: Group) -> Iterator[str]:
    """Return a table of a paper; of a long one the figures that differ, and how many come out."""
    yield from (f"### {group.title}", "", group.note, "")
    told = [one for one in group.figures if len(group.figures) <= LONG or one.standing is Standing.DIFFERS]
    if told:
        heads = ("figure", "paper", "ours", "difference") if group.published else ("figure", "ours")
        yield from _table(heads, (_row(one, len(heads)) for one in told))
    if len(told) < len(group.figures):
        others = "figures come out" if not told else "others come out"
        yield from (f"{group.agreeing} {others}; `heliopanel papers` prints them all.", "")
    for remark in remarks(group):
        yield from (remark, "")


def _row(figure: Figure, columns: int) -> tuple[str, ...]:
    name = f"{figure.name}, {figure.unit}" if figure.unit else figure.name
    told, ours, apart = shown(figure)
    return (name, ours) if columns == 2 else (name, told, ours, apart)


def _table(heads: tuple[str, ...], rows: Iterator[tuple[str, ...]]) -> Iterator[str]:
    yield _line(heads)
    yield _line(("---",) * len(heads))
    yield from (_line(tuple(cell.replace("|", "\\|") for cell in row)) for row in rows)
    yield ""


def _line(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"
