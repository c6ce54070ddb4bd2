"""The commissioning record as a file for people, HTML or PDF, in the language of the request."""

from base64 import b64encode
from html import escape

from app.base.extras import need
from app.base.startup import late
from app.web.features.records.record_files import Paper, PaperPhoto
from app.web.features.records.record_words import HASHED, IN_ENGLISH, own
from app.web.features.records.signatures import HEIGHT, WIDTH, Signature
from app.web.languages import CATALOGUE, said, spoken
from app.web.languages.known import ENGLISH


def heads(paper: Paper) -> tuple[str, ...]:
    """Return what stands below the title: number, hash, and which language was signed."""
    told = [paper.mark]
    if paper.digest:
        told.append(own(HASHED, digest=paper.digest))
    if paper.digest and CATALOGUE.get().language is not ENGLISH:
        told.append(own(IN_ENGLISH))
    return tuple(map(said, told))


def record_html(paper: Paper) -> str:
    """Return a record as one HTML file that needs nothing else, in the language of the request."""
    head = "<br>".join(map(escape, heads(paper)))
    title = escape(said(paper.title))
    parts = [
        f"<!doctype html><html lang='{spoken().tag}'><meta charset='utf-8'>",
        f"<title>{title}</title><h1>{title}</h1><p>{head}</p>",
    ]
    for heading, rows in paper.sections:
        lines = (
            f"<tr><th align='left'>{escape(said(name))}</th><td>{escape(said(value))}</td></tr>"
            for name, value in rows
        )
        parts.append(f"<h2>{escape(said(heading))}</h2><table>{''.join(lines)}</table>")
    parts += [_photo_html(one) for one in paper.photos]
    parts += [_signature_html(one) for one in paper.signatures]
    return "\n".join([*parts, "</html>"])


def _photo_html(photo: PaperPhoto) -> str:
    source = f"data:image/jpeg;base64,{b64encode(photo.content).decode()}"
    caption = escape(photo.caption)
    return (
        f"<figure><img src='{source}' width='480' alt='{caption}'><figcaption>{caption}</figcaption></figure>"
    )


def _signature_html(one: Signature) -> str:
    drawn = (
        f"<svg viewBox='0 0 {WIDTH} {HEIGHT}' width='400' role='img'><path d='{one.path}' fill='none' "
        "stroke='#000' stroke-width='5'/></svg>"
        if one.strokes
        else "<br><br>"
    )
    return f"<p>{drawn}<br>________________________<br>{escape(said(one.words))}: {escape(one.name)}</p>"


def record_pdf(paper: Paper) -> bytes:
    """Return the record as a PDF on A4: every section a table, photos, and signatures or lines to sign on."""
    need("pdf")
    printed: bytes = late("app.web.features.records.record_pdf").printed(paper, heads(paper))
    return printed
