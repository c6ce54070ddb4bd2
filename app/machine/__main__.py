"""`python -m app.machine`: the controller service as a process of its own."""

import sys

from app.foreseen import Foreseen
from app.late import hurry, late
from app.machine.supervisor import end_with_parent
from app.settings import read_settings

SUPERVISED = "--supervised="


def main() -> int:
    """Run until told to stop and return the exit code."""
    for argument in sys.argv[1:]:
        if argument.startswith(SUPERVISED):
            end_with_parent(int(argument.removeprefix(SUPERVISED)))
    hurry()
    try:
        late("app.machine.main").run(read_settings())
    except Foreseen as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
