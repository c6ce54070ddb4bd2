"""`python -m app.machine`: the controller service as a process of its own."""

import sys

from app.late import hurry, late
from app.machine.lock import AlreadyRunning
from app.machine.supervisor import WRONG_SETTINGS, end_with_parent
from app.settings import SettingsWrong, read_settings
from app.store.store import StoreFailed

SUPERVISED = "--supervised="


def main() -> int:
    """Run until told to stop and return the exit code."""
    for argument in sys.argv[1:]:
        if argument.startswith(SUPERVISED):
            end_with_parent(int(argument.removeprefix(SUPERVISED)))
    hurry()
    try:
        late("app.machine.main").run(read_settings())
    except (SettingsWrong, AlreadyRunning, StoreFailed) as error:
        sys.stderr.write(f"{error}\n")
        return WRONG_SETTINGS
    return 0


if __name__ == "__main__":
    sys.exit(main())
