"""`heliopanel machine`: the controller service alone."""

from typing import Annotated

import typer

from app.machine.main import run
from app.machine.starting import as_service
from app.machine.supervisor import end_with_parent
from app.options import Config, DataDir, settle

Supervised = Annotated[int | None, typer.Option(hidden=True, help="Process id of the supervisor.")]


def machine(supervised: Supervised = None, config: Config = None, data_dir: DataDir = None) -> None:
    """Run the controller service alone, for a system service of its own."""
    if supervised is not None:
        end_with_parent(supervised)
    with as_service():
        run(settle(config, data_dir))
