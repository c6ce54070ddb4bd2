"""The commissioning record as a file for people, HTML or PDF, in the language of the request."""

from base64 import b64encode
from html import escape

from app.extras import need
from app.startup import late
from app.web.languages import said, spoken
from app.web.record_files import Paper, PaperPhoto
from app.web.record_words import heads, told
from app.web.signatures import HEIGHT, WIDTH, Signature


def record_html(signed: Paper) -> str:
    """Return a record as one HTML file that needs nothing else, in the language of the request."""
    paper = told(signed)
    head = "<br>".join(map(escape, heads(paper)))
    parts = [
        f"<!doctype html><html lang='{spoken().tag}'><meta charset='utf-8'>",
        f"<title>{escape(paper.title)}</title><h1>{escape(paper.title)}</h1><p>{head}</p>",
    ]
    for heading, rows in paper.sections:
        lines = (
            f"<tr><th align='left'>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in rows
        )
        parts.append(f"<h2>{escape(heading)}</h2><table>{''.join(lines)}</table>")
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


def record_pdf(signed: Paper) -> bytes:
    """Return the record as a PDF on A4: every section a table, photos, and signatures or lines to sign on."""
    need("pdf")
    printed: bytes = late("app.web.record_pdf").printed(told(signed))
    return printed
