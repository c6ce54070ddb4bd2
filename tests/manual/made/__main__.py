"""`python -m tests.manual.made` writes the pages of Reference that are made of the code."""

from tests.manual.made.pages import REFERENCE, pages

for name, text in pages().items():
    (REFERENCE / f"{name}.md").write_text(text)
