"""`python -m app.machine`: the controller service as a process of its own."""

import sys

from app.base.errors import Foreseen
from app.base.settings import read_settings
from app.base.startup import hurry, late
from app.machine.supervised import end_with_supervisor


def main() -> int:
    """Run until told to stop and return the exit code."""
    end_with_supervisor(sys.argv[1:])
    hurry()
    try:
        late("app.machine.main").run(read_settings())
    except Foreseen as error:
        sys.stderr.write(f"{error}\n")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
