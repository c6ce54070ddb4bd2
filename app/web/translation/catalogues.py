"""`python -m app.web.translation.catalogues`: keeps the catalogues in step with the texts of the sources.

update           add new texts to every .po file, set gone ones aside, then compile
compile          write every .mo file anew from its .po file
check            fail, with the reason, where a .po or .mo file is not current
list             write every text as a line of JSON
import LANG FILE take translations from such lines, with msgstr added
"""

import sys
from collections.abc import Iterable, Iterator
from datetime import UTC, datetime
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from typing import Any

import orjson
from babel.messages.catalog import Catalog, Message
from babel.messages.extract import DEFAULT_KEYWORDS, extract_from_dir
from babel.messages.frontend import parse_mapping_cfg
from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po, write_po

from app.base.file_text import utf8_of
from app.web.languages.catalogue import GAP
from app.web.languages.known import LOCALE, TRANSLATED

HEADER = "# Heliopanel's texts. The .mo file beside this one is made from it: see docs/develop/languages.md."
WIDTH = 108
ROOT = Path(__file__).resolve().parents[3]
KEYWORDS = {"say": None, "N_": None}
NO_DATE = datetime(2000, 1, 1, tzinfo=UTC)
"""Stands for the dates of a catalogue, so that the same texts make the same file."""


def template() -> Catalog:
    """Return all texts of the sources, with where they stand, as `babel.cfg` tells Babel to find them.

    What has only gaps and signs is the same in every language.
    """
    catalog = Catalog(project="Heliopanel", charset="utf-8", header_comment=HEADER)
    with (ROOT / "babel.cfg").open() as mapping:
        methods, options = parse_mapping_cfg(mapping)  # type: ignore[no-untyped-call] # Babel's
    found = extract_from_dir(ROOT, methods, options, DEFAULT_KEYWORDS | KEYWORDS)
    for path, line, message, _, context in found:
        if any(map(str.isalpha, GAP.sub("", str(message)))):
            catalog.add(message, locations=[(path, line)], context=context)
    return catalog


def path_of(code: str, ending: str = "po") -> Path:
    """Return the file of a language's catalogue."""
    return LOCALE / code / "LC_MESSAGES" / f"heliopanel.{ending}"


def read(code: str) -> Catalog:
    """Return a language's catalogue as it is stored, empty where there is none yet."""
    path = path_of(code)
    if not path.exists():
        return Catalog(locale=code, project="Heliopanel", charset="utf-8")
    with path.open("rb") as source:
        return read_po(source, locale=code)


def renewed(stored: Catalog, fresh: Catalog) -> Catalog:
    """Return a language's catalogue with the texts of the sources; what was translated once comes back."""
    known = {(one.context, one.id): one.string for one in (*stored.obsolete.values(), *stored) if one.id}
    catalog = Catalog(locale=stored.locale, project="Heliopanel", charset="utf-8", header_comment=HEADER)
    for text in fresh:
        if text.id:
            string = known.pop((text.context, text.id), None)
            catalog.add(text.id, string, _files(text), context=text.context)
    for (context, name), string in known.items():
        if any(string if isinstance(string, tuple) else (string,)):
            key = (name, context) if context else name
            catalog.obsolete[key] = Message(name, string, context=context)
    return catalog


def _files(text: Message) -> list[tuple[str, int]]:
    """Return the files of a text without lines, which would change with every edit."""
    return [(path, 0) for path in dict.fromkeys(path for path, _ in text.locations)]


def po_text(catalog: Catalog) -> bytes:
    """Return a catalogue as the .po file that is committed: no dates, no lines, always in the same order."""
    written = BytesIO()
    write_po(written, catalog, width=WIDTH, include_lineno=False, omit_header=True)
    plural = f'"Plural-Forms: {catalog.plural_forms}\\n"'
    head = (
        f'{HEADER}\nmsgid ""\nmsgstr ""\n"Language: {catalog.locale}\\n"\n{plural}\n'
        '"MIME-Version: 1.0\\n"\n"Content-Type: text/plain; charset=utf-8\\n"\n'
        '"Content-Transfer-Encoding: 8bit\\n"\n\n'
    )
    return head.encode() + written.getvalue()


def mo_bytes(catalog: Catalog) -> bytes:
    """Return a catalogue as gettext reads it; a text that is not translated is not in it."""
    written = BytesIO()
    for text in catalog:
        if isinstance(text.string, tuple) and not all(text.string):
            text.string = ""
    catalog.creation_date = catalog.revision_date = NO_DATE
    write_mo(written, catalog)
    return written.getvalue()


def update() -> None:
    """Bring every .po file up to date, then every .mo file."""
    fresh = template()
    for code in TRANSLATED:
        write(code, renewed(read(code), fresh))


def compile_all() -> None:
    """Write every .mo file anew."""
    for code in TRANSLATED:
        path_of(code, "mo").write_bytes(mo_bytes(read(code)))


def faults(fresh: Catalog) -> Iterator[str]:
    """Return what is not current, as sentences."""
    wanted = {(text.context, text.id) for text in fresh if text.id}
    for code in TRANSLATED:
        stored = read(code)
        if wanted != {(text.context, text.id) for text in stored if text.id}:
            yield f"{path_of(code)} has not the texts of the sources: run make translations."
        made = path_of(code, "mo")
        if not made.exists() or made.read_bytes() != mo_bytes(stored):
            yield f"{made} does not belong to its .po file: run make translations."


def untranslated(stored: Catalog) -> list[object]:
    """Return the texts that a language does not have yet: they are shown in English."""
    return [text.id for text in stored if text.id and not all(text.string or ("",))]


def identity(context: str | None, name: object) -> str:
    """Return a name for a text that stays the same whatever else is added."""
    return sha256(orjson.dumps([context or "", name])).hexdigest()[:10]


def listed() -> Iterator[dict[str, Any]]:
    """Return every text for translators, related ones together."""
    for text in template():
        if text.id:
            one, many = text.id if isinstance(text.id, tuple) else (text.id, "")
            where = list(dict.fromkeys(path for path, _ in text.locations))
            yield {
                "id": identity(text.context, text.id),
                "context": text.context or "",
                "msgid": one,
                "plural": many,
                "where": where,
            }


def take(catalog: Catalog, lines: Iterable[dict[str, Any]]) -> tuple[Catalog, int]:
    """Put translations into a catalogue; return it, and how many belong to no text."""
    by_identity = {identity(text.context, text.id): text for text in catalog if text.id}
    unknown = 0
    for line in lines:
        text = by_identity.get(str(line.get("id")))
        text = text or catalog.get(line.get("msgid", ""), line.get("context") or None)
        if text is None or not line.get("msgstr"):
            unknown += 1
            continue
        text.string = _string(text, line["msgstr"], catalog.num_plurals)
    return catalog, unknown


def write(code: str, catalog: Catalog) -> None:
    """Store a language's catalogue, and what gettext reads of it."""
    path_of(code).parent.mkdir(parents=True, exist_ok=True)
    path_of(code).write_bytes(po_text(catalog))
    path_of(code, "mo").write_bytes(mo_bytes(read(code)))


def import_lines(code: str, file: Path) -> None:
    """Take translations from lines of JSON."""
    lines = [orjson.loads(line) for line in utf8_of(file.read_bytes()).splitlines() if line.strip()]
    catalog, unknown = take(renewed(read(code), template()), lines)
    write(code, catalog)
    sys.stdout.write(f"{len(lines) - unknown} translations taken, {unknown} belong to no text.\n")


def _string(text: Message, given: str | list[str], forms: int) -> str | tuple[str, ...]:
    if not isinstance(text.id, tuple):
        return given if isinstance(given, str) else given[-1]
    strings = [given] if isinstance(given, str) else list(given)
    return tuple((strings + [strings[-1]] * forms)[:forms])


def main(asked: list[str]) -> int:
    """Do what was asked for; return the exit status."""
    match asked:
        case ["update"]:
            update()
        case ["compile"]:
            compile_all()
        case ["check"]:
            found = list(faults(template()))
            sys.stderr.writelines(f"{fault}\n" for fault in found)
            return 1 if found else 0
        case ["list"]:
            sys.stdout.writelines(f"{orjson.dumps(line).decode()}\n" for line in listed())
        case ["import", code, file] if code in TRANSLATED:
            import_lines(code, Path(file))
        case _:
            sys.stderr.write(__doc__ or "")
            return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
