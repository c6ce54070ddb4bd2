"""What belongs to this installation: the folders beside the program, and its modules as processes.

In a checkout the folders lie beside `app`; a wheel carries them inside it (`setup.py`), for `static`,
`docs` and `alembic` are other people's names in a folder of libraries.
"""

import sys
from pathlib import Path

PROGRAM = Path(__file__).resolve().parents[1]
CARRIED = PROGRAM / "_carried"


def own_folder(name: str) -> Path:
    """Return one of the folders `alembic`, `docs`, `manual`, `static` and `templates`."""
    carried = CARRIED / name
    return carried if carried.is_dir() else PROGRAM.parent / name


def own_process(module: str) -> tuple[str, ...]:
    """Return the command that runs one of our modules, also where the present folder has an `app` too.

    Python keeps no columns of source lines for it: carets in a log are not worth their memory.
    """
    return (sys.executable, "-P", "-X", "no_debug_ranges", "-m", module)
