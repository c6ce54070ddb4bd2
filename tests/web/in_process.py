"""What the panel leaves to processes of their own, worked out in a thread of the test's process.

A process that only imports takes two to three processor seconds; what it works out, and how that is told, is
the same. Tests of the processes themselves ask for the fixture `real_processes`.
"""

import asyncio
from collections.abc import AsyncGenerator
from concurrent.futures import ThreadPoolExecutor
from contextvars import ContextVar
from datetime import timedelta

import pytest

from app.studies import worker
from app.studies.jobs import JOB, TOLD, Job, Told
from app.web.services import simulations, studies
from tests.patience import PATIENCE_S

LINES: ContextVar[list[bytes]] = ContextVar("LINES")


class ThreadWorker(ThreadPoolExecutor):
    """One thread in the place of a process."""

    def __init__(self, workers: int, **_of_the_process: object) -> None:
        super().__init__(workers)


async def told_here(job: Job) -> AsyncGenerator[Told, None]:
    """Yield what the worker of studies tells about a job, by the lines that it reads and writes."""
    for line in await asyncio.to_thread(_lines, JOB.dump_json(job)):
        yield TOLD.validate_json(line)


def _lines(asked: bytes) -> list[bytes]:
    LINES.set([])
    worker.tell(worker._answer(asked))
    return LINES.get()


def be_patient(patch: pytest.MonkeyPatch) -> None:
    """Have the panel wait for its calculations as long as tests wait: a busy computer may take its time."""
    patch.setattr(studies, "LONGEST_QUESTION", timedelta(seconds=PATIENCE_S))
    patch.setattr(studies, "LONGEST", timedelta(seconds=PATIENCE_S))
    patch.setattr(simulations, "LONGEST", timedelta(seconds=PATIENCE_S))


def work_here(patch: pytest.MonkeyPatch) -> None:
    """Have simulations and studies worked out in this process from now on."""
    be_patient(patch)
    patch.setattr(simulations, "ProcessPoolExecutor", ThreadWorker)
    patch.setattr(studies, "_told", told_here)
    patch.setattr(worker, "tell", lambda told: LINES.get().append(TOLD.dump_json(told)))
