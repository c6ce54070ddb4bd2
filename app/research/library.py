"""The five papers by name, and as text."""

from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from textwrap import fill
from types import MappingProxyType
from typing import Final

from app.base.startup import late
from app.research.result import Basis, Figure, Group, Paper, Standing


def _worked_out(name: str) -> Paper:
    """Return what the module of a paper finds; it is loaded only then, with all that computing needs."""
    found: Paper = getattr(late(f"app.research.{name}"), name)()
    return found


LIBRARY: Final[Mapping[str, Callable[[], Paper]]] = MappingProxyType(
    {
        "gezegin-dirik": partial(_worked_out, "gezegin"),
        "nalini-hemavathi": partial(_worked_out, "nalini"),
        "xia": partial(_worked_out, "xia"),
        "psa-rexroth": partial(_worked_out, "psa_rexroth"),
        "alexandru": partial(_worked_out, "alexandru"),
    }
)
WIDE = 110
MARKS = {Standing.AGREES: "", Standing.DIFFERS: "differs", Standing.MEASURED: ""}
BASES = {
    Basis.COMPUTED: "",
    Basis.FITTED: "Fitted: a value that the paper leaves out was chosen so that this comes out.",
    Basis.PRINTED: "From other numbers that the paper prints, not from its equations.",
}


class UnknownPaper(ValueError):
    """A paper that is not among the five."""


@cache
def paper(key: str) -> Paper:
    """Return a paper, computed once; raises `UnknownPaper`."""
    if key not in LIBRARY:
        raise UnknownPaper(f"There is no paper {key}: choose one of {', '.join(LIBRARY)}.")
    return LIBRARY[key]()


def papers(keys: tuple[str, ...] = ()) -> tuple[Paper, ...]:
    """Return papers by their keys, without any all five; raises `UnknownPaper`."""
    return tuple(paper(key) for key in keys or LIBRARY)


def text(found: tuple[Paper, ...]) -> str:
    """Return the papers as text: the paper's value, ours, the difference; errata; what cannot be had."""
    return "\n".join(line for one in found for line in _lines(one))


def shown(figure: Figure) -> tuple[str, str, str]:
    """Return the published value, ours and the difference, as they are printed; empty where there is none."""
    told, apart = figure.published, figure.difference
    return (
        "" if told is None else f"{told:.{figure.digits}f}",
        f"{figure.ours:.{figure.digits}f}",
        "" if apart is None else f"{apart:+z.{figure.digits}f}",
    )


def remarks(group: Group) -> tuple[str, ...]:
    """Return what is remarked on the figures of a group, each remark once, after the names it is about."""
    about: dict[str, list[str]] = {}
    for figure in group.figures:
        for remark in (BASES[figure.basis], figure.remark):
            about.setdefault(remark, []).append(figure.name)
    return tuple(f"{'; '.join(names)}: {remark}" for remark, names in about.items() if remark)


def _lines(one: Paper) -> Iterator[str]:
    yield from (f"{'=' * WIDE}", one.name, fill(one.citation, WIDE))
    yield one.summary
    for group in one.groups:
        yield from ("", group.title, fill(group.note, WIDE, initial_indent="  ", subsequent_indent="  "))
        yield f"  {'':<52}{'paper':>12}{'ours':>12}{'difference':>12}"
        yield from (_figure(figure) for figure in group.figures)
        yield from (f"  {remark}" for remark in remarks(group))
    yield from ("", "Errata: printed -> right: effect")
    for erratum in one.errata:
        told = f"{erratum.where}: {erratum.printed} -> {erratum.right}: {erratum.effect.text}"
        yield fill(told, WIDE, initial_indent="  ", subsequent_indent="      ")
    yield from ("", "Not reproduced")
    for gap in one.gaps:
        yield fill(f"{gap.what}: {gap.why}", WIDE, initial_indent="  ", subsequent_indent="      ")
    yield ""


def _figure(figure: Figure) -> str:
    told, ours, apart = shown(figure)
    name = f"{figure.name} [{figure.unit}]" if figure.unit else figure.name
    return f"  {name:<52}{told:>12}{ours:>12}{apart:>12}  {MARKS[figure.standing]}".rstrip()
