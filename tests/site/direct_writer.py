"""A writer without a thread of its own."""

from collections.abc import Callable
from typing import TypeVar

from app.store.store import Writer

T = TypeVar("T")


class DirectWriter:
    """Does every write at once and in order."""

    def __init__(self, writer: Writer) -> None:
        self.writer = writer

    async def call(self, work: Callable[[Writer], T]) -> T:
        return work(self.writer)

    def post(self, work: Callable[[Writer], object]) -> bool:
        work(self.writer)
        return True
