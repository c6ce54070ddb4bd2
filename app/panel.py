"""`python -m app.panel`: the panel as a process of its own, without what the command line loads."""

import sys

from app.base.errors import Foreseen
from app.base.settings import Settings, read_settings
from app.base.startup import hurry, late
from app.machine.process import raise_priority_of_panel
from app.machine.starting import as_service, check_certificate, check_data_dir, check_port
from app.machine.supervised import end_with_supervisor, tell_ready


def serve(settings: Settings) -> None:
    """Run the panel until it is told to end; raises `Foreseen` for what keeps it from starting."""
    check_data_dir(settings.data_dir)
    check_port(settings)
    check_certificate(settings)
    with as_service():
        late("app.web.main").run(settings, on_answer=_answers)


def _answers(settings: Settings) -> None:
    """Be punctual from now on, and say where a browser finds the panel."""
    raise_priority_of_panel(settings)
    tell_ready()
    host = f"[{settings.host}]" if ":" in settings.host else settings.host
    sys.stdout.write(f"Heliopanel answers: open {settings.scheme}://{host}:{settings.port}\n")
    sys.stdout.flush()


def main() -> int:
    """Run until told to stop and return the exit code."""
    end_with_supervisor(sys.argv[1:])
    hurry()
    try:
        serve(read_settings())
    except Foreseen as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
