"""What each property of the document is, where its schema does not say so itself.

`properties.txt` has a line for each name, since the same name means the same wherever it is; where it does
not, the line begins with the name of the schema.
"""

from pathlib import Path
from typing import Any


def told() -> dict[str, str]:
    """Return every description by `property` or `Schema.property`."""
    lines = Path(__file__).with_name("properties.txt").read_text(encoding="utf-8").splitlines()
    return dict(line.split(": ", 1) for line in lines)


def describe(schemas: dict[str, dict[str, Any]]) -> None:
    """Describe every property that its schema does not describe."""
    known = told()
    for name, schema in schemas.items():
        for key, field in schema.get("properties", {}).items():
            if not field.get("description"):
                field["description"] = known.get(f"{name}.{key}", known.get(key, ""))
