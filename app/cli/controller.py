"""`heliopanel controller`: the controller service alone."""

from app.cli.options import Config, DataDir, settle
from app.machine.main import run
from app.machine.starting import as_service


def controller(config: Config = None, data_dir: DataDir = None) -> None:
    """Run the controller service alone, for a system service of its own."""
    with as_service():
        run(settle(config, data_dir))
