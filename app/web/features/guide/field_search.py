"""Which fields the forms of the pages have, read from the templates, for the search."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

from jinja2 import nodes

from app.base.message import N_, NOTHING, Message, plain
from app.web.shell.formats import range_said
from app.web.shell.render import environment

SITE_FORMS = (
    ("overview.html", N_("Trackers"), "/"),
    ("simulate.html", N_("Simulate a day"), "/simulate"),
    ("studies.html", N_("Energy studies"), "/studies"),
    ("step_program.html", N_("Best step program"), "/studies/program"),
    ("accuracy.html", N_("Accuracy"), "/accuracy"),
    ("journal.html", N_("Journal"), "/journal"),
    ("site.html", N_("Site"), "/site"),
    ("horizon.html", N_("Horizon"), "/site/horizon"),
    ("network.html", N_("Network"), "/network"),
    ("users.html", N_("Users"), "/users"),
    ("tokens.html", N_("Tokens"), "/tokens"),
)
TRACKER_FORMS = (
    ("tracker.html", N_("Live"), ""),
    ("location.html", N_("Location"), "/commissioning/location"),
    ("clock_shadow.html", N_("Clock"), "/commissioning/clock/shadow"),
    ("settings.html", N_("Settings"), "/settings"),
    ("drive.html", N_("Drive"), "/drive"),
    ("mount.html", N_("Mount"), "/mount"),
    ("strategy.html", N_("Strategy"), "/strategy"),
    ("protections.html", N_("Protections"), "/protections"),
    ("machine.html", N_("Mechanics"), "/machine"),
    ("service.html", N_("Service mode"), "/service"),
    ("show.html", N_("Show"), "/show"),
    ("record.html", N_("Record"), "/record"),
)
FIELDS = ("text_field", "select_field", "secret_field")
LABEL = re.compile(r'<label for="f-([\w-]+)">\{\{ _\("([^"]+)"\) \}\}</label>')


@dataclass(frozen=True, slots=True)
class FormField:
    """A field of a form: its name where that is fixed, its label and its hint in English."""

    name: str
    label: Message
    hint: Message


@cache
def fields_of(template: str) -> tuple[FormField, ...]:
    """Return the fields of a template that have a label of their own."""
    env = environment()
    source = env.loader.get_source(env, template)[0] if env.loader else ""
    written = (FormField(name, plain(label), NOTHING) for name, label in LABEL.findall(source))
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


def _text(node: nodes.Node | None) -> Message:
    """Return the English text of `_("…")`, `pgettext("…", "…")` without gaps, or a range."""
    match node:
        case nodes.Call(node=nodes.Name(name="_"), args=[nodes.Const(value=str(text))], kwargs=[]):
            return plain(text)
        case nodes.Call(node=nodes.Name(name="pgettext"), args=[_, nodes.Const(value=str(text))]):
            return plain(text)
        case nodes.Call(node=nodes.Name(name="range_hint"), args=[*ends]):
            given = [end.as_const() for end in ends if isinstance(end, nodes.Const | nodes.Neg)]
            return range_said(*given) if len(given) == len(ends) else NOTHING
        case _:
            return NOTHING
