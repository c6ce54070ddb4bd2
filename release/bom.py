"""The software bill of materials: every locked library and every vendored file's package, as CycloneDX."""

import json
import re
from datetime import datetime
from pathlib import Path
from uuid import NAMESPACE_URL, uuid5

from cyclonedx.contrib.license.factories import LicenseFactory
from cyclonedx.model import HashAlgorithm, HashType, Property
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.output.json import JsonV1Dot6
from cyclonedx.schema import SchemaVersion
from packageurl import PackageURL

from release.refused import Refused

LOCKED = re.compile(
    r"(?P<name>[A-Za-z0-9._-]+)==(?P<version>[^\s;\\]+)(?:\s*;\s*(?P<marker>[^\\]+?))?\s*\\?$"
)
HASH = re.compile(r"--hash=sha256:(?P<digest>[0-9a-f]{64})")
NOT_SHIPPED = {"setuptools"}
"""What only builds the wheel."""


def bill(sources: Path, version: str, made_at: datetime) -> str:
    """Return the bill of a checkout as JSON, valid by the schema; the same checkout makes the same text."""
    bom = Bom(serial_number=uuid5(NAMESPACE_URL, f"heliopanel {version}"))
    bom.metadata.timestamp = made_at
    root = bom.metadata.component = Component(
        name="heliopanel",
        version=version,
        type=ComponentType.APPLICATION,
        bom_ref=f"heliopanel@{version}",
        purl=PackageURL("pypi", name="heliopanel", version=version),
        licenses=[LicenseFactory().make_from_string("Apache-2.0")],
    )
    parts = [*locked((sources / "requirements.txt").read_text()), *vendored(sources / "static" / "vendor")]
    bom.components.update(parts)
    bom.register_dependency(root, parts)
    text = JsonV1Dot6(bom).output_as_string(indent=2) + "\n"
    from cyclonedx.validation.json import JsonStrictValidator  # noqa: PLC0415 - takes seconds to load

    errors = JsonStrictValidator(SchemaVersion.V1_6).validate_str(text)
    if errors is not None:
        raise Refused(f"The bill of materials does not follow its schema: {errors}")
    return text


def locked(requirements: str) -> list[Component]:
    """Return the libraries of locked requirements; their hashes are those of all files that may be taken."""
    found: list[Component] = []
    for line in requirements.splitlines():
        if begins := LOCKED.match(line):
            found.append(_library(begins["name"], begins["version"], begins["marker"]))
        elif (digest := HASH.search(line)) and found:
            found[-1].hashes.add(HashType(alg=HashAlgorithm.SHA_256, content=digest["digest"]))
    return [one for one in found if one.name not in NOT_SHIPPED]


def vendored(folder: Path) -> list[Component]:
    """Return the packages whose files come with the pages."""
    known = json.loads((folder / "manifest.json").read_text())
    return [
        Component(
            name=one["package"],
            version=one["version"],
            type=ComponentType.LIBRARY,
            bom_ref=f"{one['package']}@{one['version']}",
            licenses=[LicenseFactory().make_from_string(one["licence"])],
            properties=[Property(name="heliopanel:files", value=", ".join(sorted(one["files"])))],
        )
        for one in known.values()
    ]


def _library(name: str, version: str, marker: str | None) -> Component:
    return Component(
        name=name,
        version=version,
        type=ComponentType.LIBRARY,
        bom_ref=f"{name}@{version}",
        purl=PackageURL("pypi", name=name, version=version),
        properties=[Property(name="heliopanel:only_where", value=marker)] if marker else [],
    )
