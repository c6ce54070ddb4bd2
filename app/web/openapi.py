"""Writes docs/openapi.json: `python -m app.web.openapi`."""

from app.base.settings import Settings
from app.web.documented import DOCUMENT, written
from app.web.main import create_app

if __name__ == "__main__":
    DOCUMENT.write_text(written(create_app(Settings())), encoding="utf-8")
