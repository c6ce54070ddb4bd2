"""Every setting: its variable, its default, what may be set and what it does."""

from pathlib import Path
from types import NoneType
from typing import Any, Literal, get_args, get_origin

from pydantic import SecretStr
from pydantic.fields import FieldInfo

from app.base.settings import FILE_VARIABLE, PREFIX, Settings
from tools.manual.made.markdown import code, page, table

INTRODUCTION = f"""Settings come from options of the command line, then from the environment, then from
what the page *Network* has set, then from the TOML file that `{FILE_VARIABLE}` names; what comes first
counts. In the file a setting has the name of its variable in lower case, without `{PREFIX}`.

`heliopanel config check` prints what differs from the defaults, and finds what is wrong before anything
starts. The controller service and the web process read settings when they start."""
GROUPS = {
    "General": "",
    "SunSpec": "sunspec_",
    "MQTT": "mqtt_",
    "Webhooks": "webhook_",
    "Mail": "smtp_",
}
"""The headings, and what the names below them begin with."""

KINDS = {
    bool: "`1` or `0`", int: "whole number", float: "number", str: "text", Path: "path", SecretStr: "secret",
    tuple: "list, separated by commas",
}  # fmt: skip
BOUNDS = {
    "ge": "from",
    "gt": "above",
    "le": "to",
    "lt": "below",
    "max_length": "at most",
    "min_length": "at least",
}


def settings_page() -> str:
    """Return the page."""
    return page("Settings", INTRODUCTION, *(_group(title, start) for title, start in GROUPS.items()))


def _group(title: str, start: str) -> str:
    others = tuple(filter(None, GROUPS.values()))
    fields = {
        name: field
        for name, field in Settings.model_fields.items()
        if (name.startswith(start) if start else not name.startswith(others))
    }
    rows = [
        (code(PREFIX + name.upper()), _default(field), _values(field), field.description or "")
        for name, field in fields.items()
    ]
    return f"## {title}\n\n" + table(("variable", "default", "value", "what"), rows)


def _default(field: FieldInfo) -> str:
    match field.default:
        case None | () | "":
            return "none"
        case bool(chosen):
            return code(int(chosen))
        case chosen:
            return code(chosen)


def _values(field: FieldInfo) -> str:
    kinds = [kind for kind in get_args(field.annotation) or (field.annotation,) if kind is not NoneType]
    if get_origin(field.annotation) is Literal:
        return ", ".join(code(kind) for kind in kinds)
    kind: Any = tuple if get_origin(field.annotation) is tuple else kinds[0]
    bounds = [
        f"{word} {getattr(limit, name):g}"
        for limit in field.metadata
        for name, word in BOUNDS.items()
        if getattr(limit, name, None) is not None
    ]
    letters = ["letters"] if bounds and kind is str else []
    return " ".join((KINDS[kind], *bounds, *letters)).replace("text at", "text, at")
