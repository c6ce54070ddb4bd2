"""`heliopanel machine`: the controller service alone."""

from typing import Annotated

import typer

from app.machine.main import run
from app.machine.supervisor import end_with_parent
from app.settings import read_settings

Supervised = Annotated[int | None, typer.Option(hidden=True, help="Process id of the supervisor.")]


def machine(supervised: Supervised = None) -> None:
    """Run the controller service alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    run(read_settings())
