"""Templates and how a declared context becomes a page, or the one block of it that htmx asked for."""

from collections.abc import Callable, Iterable
from dataclasses import fields
from functools import cache, wraps
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined, pass_context
from jinja2.runtime import Context as TemplateContext
from jinja2.runtime import Macro
from jinja2_fragments import render_block
from markupsafe import Markup
from starlette.requests import Request
from starlette.responses import HTMLResponse, RedirectResponse, Response

from app.alarms.urgency import headline
from app.base.build import VERSION
from app.base.instants import duration
from app.base.own import own_folder
from app.tracker.mounts.capabilities import abilities
from app.web import languages
from app.web.languages.catalogue import offered
from app.web.languages.script_texts import for_page
from app.web.shell import formats
from app.web.shell.allowed import shut
from app.web.shell.contexts import Context
from app.web.shell.deps import panel, principal
from app.web.shell.help import help_for
from app.web.shell.one_space import OneSpace
from app.web.shell.page_facts import message_link, page_facts, told_in_bar, told_in_page


def options_said(options: Iterable[tuple[object, str]]) -> tuple[tuple[object, str], ...]:
    """Return what a list offers, its texts in the language of the request."""
    return tuple((value, languages.said(text)) for value, text in options)


FILTERS: dict[str, Callable[..., Any]] = {
    "angle": formats.angle,
    "compass": formats.compass,
    "duration": duration,
    "signed_seconds": formats.signed_seconds,
    "decimals": formats.decimals,
    "word": formats.word,
    "words": formats.words,
    "who": formats.who,
    "thing": formats.thing,
    "local": formats.read_local,
    "format": formats.formatted,
    "zone_offset": formats.offset,
    "said": languages.said,
    "options_said": options_said,
}
IN_PLACE = {"HX-Retarget": "#content", "HX-Reselect": "#content", "HX-Reswap": "outerHTML"}
VARY = {"Vary": "HX-Request, HX-Request-Type, Cookie, Accept-Language"}


@cache
def environment() -> Environment:
    """Return the one environment of all templates: undefined names fail, everything is escaped.

    Every panel of a process shares it: a template is compiled once, which takes 10 to 100 ms.
    """
    env = Environment(
        loader=FileSystemLoader(own_folder("templates")),
        undefined=StrictUndefined,
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        extensions=["jinja2.ext.i18n", OneSpace],
    )
    env.policies["ext.i18n.trimmed"] = True
    env.install_gettext_callables(  # type: ignore[attr-defined] # the extension adds it
        languages.gettext,
        languages.ngettext,
        newstyle=True,
        pgettext=languages.pgettext,
        npgettext=languages.npgettext,
    )
    env.filters |= {name: _when_shown(told) for name, told in FILTERS.items()}
    env.globals |= {"help_for": help_for, "live": live, "world": world(), "abilities": abilities}
    env.globals |= {"languages": offered(), "range_hint": formats.range_hint}
    env.globals |= {
        "spoken": languages.spoken,
        "script_texts": for_page,
        "page_facts": page_facts,
        "version": VERSION,
        "message_link": message_link,
        "told_in_bar": told_in_bar,
        "told_in_page": told_in_page,
        "headline": headline,
    }
    for shared in (
        "_icons.html",
        "_parts.html",
        "_sunpath.html",
        "_scene.html",
        "_cartesian.html",
        "_daychart.html",
        "_help_pictures.html",
    ):
        env.globals |= _macros(env, shared)
    return env


def _when_shown(told: Callable[..., Any]) -> Callable[..., Any]:
    """Return a filter that is not worked out when a template is compiled, by whoever comes first."""

    @pass_context
    @wraps(told)
    def tell(_context: TemplateContext, *given: Any, **named: Any) -> Any:
        return told(*given, **named)

    return tell


def _macros(env: Environment, template: str) -> dict[str, object]:
    """Return the macros of a template, so that blocks can call them when they are rendered alone."""
    module = env.get_template(template).module
    return {name: value for name, value in vars(module).items() if isinstance(value, Macro)}


@cache
def world() -> Markup:
    """Return the outline of the world's land as SVG path data."""
    drawn = (own_folder("static") / "img" / "world.svg").read_text()
    return Markup(drawn.split(' d="', 1)[1].split('"', 1)[0])  # noqa: S704 - our own committed file


def reach(root: object, path: str) -> Any:
    """Return what lies at a dotted path, None where something there is not known; a number is a place."""
    value: Any = root
    for name in path.split("."):
        if value is None:
            return None
        value = value[int(name)] if isinstance(value, tuple) else getattr(value, name)
    return value


@pass_context
def live(
    context: TemplateContext, path: str, form: str = "text", style: str = "value-live", of: object = None
) -> Markup:
    """Return an element that shows one value of the snapshot and that live.js keeps up to date."""
    frame = context["frame"]
    if path.startswith("site."):
        value = reach(frame.site, path.removeprefix("site."))
    else:
        value = reach(of or frame.tracker, path)
    text = formats.shown(value, form, frame.zone)
    return Markup('<span class="{}" data-live="{}" data-form="{}">{}</span>').format(style, path, form, text)


def wants_block(request: Request) -> bool:
    """Return whether htmx asked for a part of a page, not for the page."""
    headers = request.headers
    full = headers.get("HX-Request-Type") == "full" or "HX-History-Restore-Request" in headers
    return headers.get("HX-Request") == "true" and not full


def page(request: Request, context: Context, *, block: str | None = None, status: int = 200) -> Response:
    """Answer with the whole page, or with only its block when htmx asked for that."""
    env: Environment = request.app.state.templates
    given = {field.name: getattr(context, field.name) for field in fields(context)}
    given["static"] = panel(request).assets.url
    if block and wants_block(request):
        text = render_block(env, context.template, block, given)
    else:
        text = env.get_template(context.template).render(given)
    text = shut(text, principal(request), request.app.state.routes)
    return HTMLResponse(text, status, VARY)


def whole_page(request: Request, context: Context, *, status: int = 200) -> Response:
    """Answer a form with its whole page, whose content htmx puts in place; a refusal stays at the form."""
    response = page(request, context, status=status)
    response.headers.update(IN_PLACE)
    return response


def go(request: Request, url: str) -> Response:
    """Send the browser to another page, whether htmx or a plain form asked."""
    if request.headers.get("HX-Request") == "true":
        return Response(status_code=204, headers={"HX-Redirect": url})
    return RedirectResponse(url, 303)
