"""The form of the protections page: its groups, as their settings are declared."""

from dataclasses import fields, replace

from app.base.message import join, word
from app.tracker.settings.declared import declared
from app.tracker.settings.protections import ProtectionConfig, Stows
from app.web.features.setup.protection_contexts import Group
from app.web.shell.contexts import SettingRow
from app.web.shell.setting_forms import below, field_name, rows

GROUPS = tuple(field.name for field in fields(ProtectionConfig) if field.name not in ("stows", "warning_s"))
STOWS = tuple(field.name for field in fields(Stows))


def names() -> tuple[str, ...]:
    """Return every field of the form."""
    return tuple(map(field_name, declared(ProtectionConfig)))


def groups() -> tuple[Group, ...]:
    """Return the protections with their settings."""
    return tuple(group_of(ProtectionConfig, name) for name in GROUPS)


def stows() -> tuple[Group, ...]:
    """Return the stow positions, each with its elevation and its azimuth."""
    return tuple(map(_stow, STOWS))


def _stow(name: str) -> Group:
    group = group_of(ProtectionConfig, f"stows.{name}")
    labels = (join(", ", (group.title, word(row.label.lower()))) for row in group.settings)
    named = (replace(row, label=label) for row, label in zip(group.settings, labels, strict=True))
    return replace(group, settings=tuple(named))


def fixed() -> tuple[SettingRow, ...]:
    """Return the settings that belong to no protection."""
    return rows(below(ProtectionConfig, ""))


def group_of(kind: type[object], path: str) -> Group:
    """Return a group of settings by its path."""
    settings = below(kind, path)
    said = settings[0].groups[-1]
    return Group(path.rpartition(".")[2], said.label, said.help, rows(settings))
