"""Every text of the project that a page can show: of templates, modules, scripts, profiles and documents."""

from collections.abc import Iterator
from dataclasses import dataclass
from http import HTTPStatus
from pathlib import Path

from babel.messages.extract import DEFAULT_KEYWORDS, extract

from app.access.roles import ORDERS
from app.web import guide, record_words
from app.web.languages.catalogue import DOCUMENTS
from app.web.languages.known import in_words
from app.web.languages.profile_texts import profile_texts
from app.web.languages.python_texts import python_texts
from app.web.languages.script_texts import texts_of

ROOT = Path(__file__).resolve().parents[3]
JINJA = {
    "extensions": "jinja2.ext.i18n",
    "trimmed": "true",
    "newstyle_gettext": "true",
    "trim_blocks": "true",
    "lstrip_blocks": "true",
    "silent": "false",
}

_SPEAKING = """
    app/tracker app/alarms app/web app/site app/drives app/show app/access app/store app/studies app/energy
    app/sun app/link app/extras.py app/hosts.py app/gateway/gateways.py app/gateway/notices.py
    app/gateway/notifier.py app/gateway/mqtt.py app/gateway/mqtt_commands.py app/gateway/sunspec.py
    app/gateway/sunspec_controls.py app/gateway/sunspec_device.py app/gateway/calibration.py
    app/machine/safe_mode.py app/machine/memory.py"""
"""What has texts that reach a page, in the order in which they are listed."""

_HAPPENED = """
    user_added roles_changed password_changed user_removed token_made token_revoked session_ended
    factory_reset stepped_up log_in refused_log_in refused_token refused_foreign refused_stops
    refusals_left_out network_tried network_kept network_rolled_back network_not_served"""
"""What the record of the panel's door calls what happened."""

_PHRASES = (400, 401, 403, 404, 405, 409, 413, 422, 423, 429, 500, 503)
MORE = {
    "app/web/errors.py": tuple(HTTPStatus(status).phrase for status in _PHRASES),
    "app/web/ui/search_index.py": ("{least} to {most} {unit}.",),
    "app/site/recorder.py": ("Completed", "Stopped", "Interrupted"),
    "app/access/roles.py": tuple(map(in_words, ORDERS)),
    "app/access/accounts.py": tuple(map(in_words, _HAPPENED.split())),
    "app/site/auditing.py": ("refused: {reason}", "failed: {why}"),
    "app/site/timekeeping.py": ("manual", "system", "unset"),
    "app/site/site_orders.py": ("flat",),
    "app/gateway/ports.py": ("{kind} was refused: {rejected}",),
    "app/machine/main.py": ("The controller service was stopped.",),
    "app/tracker/mounts/capabilities.py": ("up", "down", "north", "south"),
}
"""What no rule finds: phrases of HTTP, parts of sentences, and words that travel."""

_SILENT = """
    app/web/languages app/web/metrics.py app/web/route_conditions.py app/web/route_permissions.py
    app/web/routes.py app/web/openapi.py app/web/documented.py app/web/main.py app/web/server.py
    app/web/hold_to_run.py app/web/record_files.py app/web/record_pdf.py app/web/record_print.py
    app/web/record_words.py app/web/journal_files.py app/web/mdns.py app/web/qr.py app/web/attachments.py
    app/web/api/base.py
    app/web/api/operations.py app/web/api/router.py app/web/ui/components.py
    app/web/ui/papers.py app/web/components_context.py app/link/codec.py
    app/drives/wire_faults.py app/drives/write_frame.py app/drives/sim_server.py app/drives/sim_training.py
    app/drives/profile_text.py app/drives/profile_needs.py app/drives/profile.py app/drives/register.py
    app/drives/rtu_frame.py app/drives/sunspec.py app/drives/sunspec_models.py
    app/drives/devices app/drives/cia402.py app/store/connections.py app/store/migrations.py
    app/store/tables.py app/store/decimate.py app/store/chunks.py app/sun/accuracy_table.py"""
"""What speaks to programs, to the journal's files or to who writes a drive profile: it stays English."""

SPEAKING, SILENT = tuple(_SPEAKING.split()), tuple(_SILENT.split())


@dataclass(frozen=True, slots=True)
class Text:
    """One text: where it stands (file and line), what it is called in English, its plural and its context."""

    path: str
    line: int
    one: str
    many: str = ""
    context: str = ""


def texts(root: Path = ROOT) -> Iterator[Text]:
    """Return all texts, those of templates first."""
    for path in sorted((root / "templates").glob("*.html")):
        yield from _of_template(path, root)
    for path in sorted((root / "static" / "js").rglob("*.js")):
        yield from _of_script(path, root)
    for named in SPEAKING:
        for path in sorted((root / named).rglob("*.py")) or (root / named,):
            yield from _of_module(path, str(path.relative_to(root)))
    for path in sorted((root / "app" / "drives" / "profiles").glob("*.toml")):
        yield from _of_profile(path, root)
    for document in guide.SPOKEN:
        yield from _of_document(document)
    words = ((text, record_words.CONTEXT) for text in dict.fromkeys(record_words.TEXTS))
    yield from (Text("app/web/record_words.py", 0, text, context=context) for text, context in words)
    for name, more in MORE.items():
        yield from (Text(name, 0, text) for text in more)


def _of_module(path: Path, name: str) -> Iterator[Text]:
    if not name.startswith(SILENT):
        for line, text in python_texts(path.read_text()):
            yield Text(name, line, text)


def _of_profile(path: Path, root: Path) -> Iterator[Text]:
    for line, text in profile_texts(path):
        yield Text(str(path.relative_to(root)), line, text)


def _of_document(name: str) -> Iterator[Text]:
    for line, markdown in guide.blocks(name):
        yield Text(f"docs/{guide.PLACES[name]}.md", line, markdown, context=DOCUMENTS)


def _of_template(path: Path, root: Path) -> Iterator[Text]:
    with path.open("rb") as source:
        for line, message, _, context in extract("jinja2", source, DEFAULT_KEYWORDS, (), JINJA):
            one, many = message if isinstance(message, tuple) else (message, "")
            yield Text(str(path.relative_to(root)), line, one, many, context or "")


def _of_script(path: Path, root: Path) -> Iterator[Text]:
    source = path.read_text()
    for at, text in texts_of(source):
        yield Text(str(path.relative_to(root)), source.count("\n", 0, at) + 1, text)
