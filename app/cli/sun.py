"""The commands about the sun itself: how accurate each algorithm is, and what the five papers come to."""

import json
from typing import Annotated

import typer

from app.research.document import document
from app.research.library import LIBRARY, papers, text
from app.sun.accuracy import Question, survey
from app.sun.accuracy_table import table
from app.sun.position import Location
from app.web.features.science.accuracy_api import AccuracyReport
from app.web.features.science.papers_api import PaperReport


def accuracy(
    lat: Annotated[float | None, typer.Option("--lat", help="Latitude of a site, north positive.")] = None,
    lon: Annotated[float | None, typer.Option("--lon", help="Longitude of a site, east positive.")] = None,
    from_year: Annotated[int, typer.Option("--from", help="First year.")] = 2000,
    to_year: Annotated[int, typer.Option("--to", help="Last year.")] = 2049,
    samples: Annotated[int, typer.Option(help="Instants to draw.")] = 100_000,
    *,
    globe: Annotated[bool, typer.Option("--globe", help="Latitude -65 to 65 instead of a site.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, with the curves.")] = False,
) -> None:
    """Measure every sun algorithm against NREL SPA, for a site or, without one, for the globe."""
    if (lat is None) != (lon is None) and not globe:
        raise ValueError("Give both --lat and --lon of a site, or neither for the globe.")
    place = None if globe or lat is None or lon is None else Location(lat, lon)
    found = survey(Question(place, from_year, to_year, samples))
    typer.echo(AccuracyReport.of(found).model_dump_json(indent=2) if as_json else table(found))


def reproduce(
    paper: Annotated[list[str] | None, typer.Option(help=f"One of {', '.join(LIBRARY)}; or all.")] = None,
    *,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    markdown: Annotated[bool, typer.Option("--markdown", help="Print Markdown.")] = False,
) -> None:
    """Print what the five papers publish, what comes out when it is computed, and the difference."""
    found = papers(tuple(paper or ()))
    if as_json:
        typer.echo(
            json.dumps([PaperReport.of(one).model_dump() for one in found], ensure_ascii=False, indent=2)
        )
        return
    typer.echo(document(found) if markdown else text(found))
