"""The pages of the panel."""

from fastapi import FastAPI


def include_pages(app: FastAPI) -> None:
    """Add every page to the application."""
