"""Which fields the forms of the pages have, read from the templates, for the search."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from jinja2 import nodes

from app.web.ui.render import environment

SITE_FORMS = (
    ("overview.html", "Trackers", "/"),
    ("simulate.html", "Simulate a day", "/simulate"),
    ("studies.html", "Energy studies", "/studies"),
    ("step_program.html", "Best step program", "/studies/program"),
    ("accuracy.html", "Accuracy", "/accuracy"),
    ("journal.html", "Journal", "/journal"),
    ("site.html", "Site", "/site"),
    ("horizon.html", "Horizon", "/site/horizon"),
    ("network.html", "Network", "/network"),
    ("users.html", "Users", "/users"),
    ("tokens.html", "Tokens", "/tokens"),
)
TRACKER_FORMS = (
    ("tracker.html", "Live", ""),
    ("location.html", "Location", "/commissioning/location"),
    ("clock.html", "Clock", "/commissioning/clock"),
    ("settings.html", "Settings", "/settings"),
    ("drive.html", "Drive", "/drive"),
    ("mount.html", "Mount", "/mount"),
    ("strategy.html", "Strategy", "/strategy"),
    ("protections.html", "Protections", "/protections"),
    ("machine.html", "Mechanics", "/machine"),
    ("service.html", "Service mode", "/service"),
    ("show.html", "Show", "/show"),
    ("record.html", "Record", "/record"),
)
FIELDS = ("text_field", "select_field", "secret_field")
LABEL = re.compile(r'<label for="f-([\w-]+)">\{\{ _\("([^"]+)"\) \}\}</label>')


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of a form: its name where that is fixed, its label and its hint in English."""

    name: str
    label: str
    hint: str


@cache
def fields_of(template: str) -> tuple[FormField, ...]:
    """Return the fields of a template that have a label of their own."""
    env = environment()
    source = env.loader.get_source(env, template)[0] if env.loader else ""
    written = (FormField(name, label, "") for name, label in LABEL.findall(source))
    return (*_called(env.parse(source)), *written)


def _called(tree: nodes.Template) -> Iterator[FormField]:
    for call in tree.find_all(nodes.Call):
        if isinstance(call.node, nodes.Name) and call.node.name in FIELDS and len(call.args) > 1:
            given = {one.key: one.value for one in call.kwargs}
            hint = given.get("hint") or (call.args[3] if len(call.args) > 3 else None)
            if label := _text(call.args[1]):
                yield FormField(_name(call.args[0]), label, _text(hint))


def _name(field: nodes.Expr) -> str:
    """Return what a field is called, of those of both axes the first, nothing where the page makes it up."""
    match field:
        case nodes.Getattr(attr=name):
            return name
        case nodes.Getitem(arg=nodes.Concat(nodes=[nodes.Name(name="axis"), nodes.Const(value=str(end))])):
            return f"azimuth{end}"
        case nodes.Getitem(arg=nodes.Const(value=str(name))) | nodes.Const(value=str(name)):
            return name
        case _:
            return ""


def _text(node: nodes.Node | None) -> str:
    """Return the English text of `_("…")`, `pgettext("…", "…")` or `"…"|said` without gaps."""
    match node:
        case nodes.Call(node=nodes.Name(name="_"), args=[nodes.Const(value=str(text))], kwargs=[]):
            return text
        case nodes.Call(node=nodes.Name(name="pgettext"), args=[_, nodes.Const(value=str(text))]):
            return text
        case nodes.Filter(name="said", node=nodes.Const(value=str(text))):
            return text
        case _:
            return ""
