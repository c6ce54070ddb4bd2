"""`python -m tools.manual.made` writes the pages of Reference that are made of the code."""

from tools.manual.made.pages import REFERENCE, pages

for name, text in pages().items():
    (REFERENCE / f"{name}.md").write_text(text)
