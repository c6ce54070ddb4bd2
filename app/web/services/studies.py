"""Studies run one after the other, each in a process of its own; ending the process cancels it."""

import asyncio
import secrets
from collections.abc import AsyncGenerator, AsyncIterator
from contextlib import aclosing, asynccontextmanager, suppress
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

from starlette.concurrency import run_in_threadpool

from app.base.clock import Clock
from app.base.extras import need
from app.base.logs import get_logger
from app.base.message import N_, say
from app.base.own import own_process
from app.fast.comparison import Comparison
from app.studies.folder import StudyFolder, StudyState, StudyStatus, StudyUnknown, WeatherFile, weather_name
from app.studies.jobs import (
    JOB,
    TOLD,
    Began,
    CheckWeather,
    CompareSite,
    FindPrograms,
    Job,
    ProgramAnswer,
    ProgramQuestion,
    ProgramsFound,
    Refused,
    SiteCompared,
    Studied,
    Told,
    WeatherSeen,
    WorkOut,
)
from app.studies.request import StudyRequest
from app.web.http.errors import Busy

log = get_logger()

WORKER = "app.studies.worker"
MOST_OPEN = 5
MOST_QUESTIONS = 2
LONGEST = timedelta(minutes=10)
LONGEST_QUESTION = timedelta(seconds=60)
LONGEST_LINE = 64 * 1024 * 1024
TOO_MANY = say(
    "{most_open} studies are under way or waiting; try again when one of them has ended.", most_open=MOST_OPEN
)
TOO_BUSY = N_("Other calculations are under way; try again when one of them has ended.")
TOO_LONG = N_(
    "The study took longer than ten minutes and was canceled: choose a longer step, fewer days, "
    "or fewer modes."
)
DIED = N_("The study process ended without a result; see the Heliopanel log for details.")


class Studies:
    """What is under way, and the folder that keeps the rest."""

    def __init__(self, data: Path, clock: Clock) -> None:
        self.folder = StudyFolder(data)
        self._clock = clock
        self._tasks: dict[str, asyncio.Task[StudyState]] = {}
        self._states: dict[str, StudyState] = {}
        self._turn = asyncio.Semaphore(1)
        self._questions = 0

    async def start(self, request: StudyRequest) -> StudyState:
        """Keep a study, begin it as soon as those before it have ended, and return its state."""
        need("studies")
        if len(self._tasks) >= MOST_OPEN:
            raise Busy(TOO_MANY)
        weather = self.folder.weather_path(request.weather_file) if request.weather_file else None
        asked_at = self._clock.system_time()
        study_id = f"{asked_at:%Y%m%dT%H%M%S}-{secrets.token_hex(3)}"
        state = StudyState(study_id, request.title, asked_at, StudyStatus.WAITING, of=len(request.cases))
        await run_in_threadpool(self.folder.open, state, request)
        job = WorkOut(request, None if weather is None else str(weather))
        self._states[study_id] = state
        task = self._tasks[study_id] = asyncio.create_task(self._run(state, job))
        task.add_done_callback(lambda ended: self._ended(state, ended))
        return state

    def states(self) -> list[StudyState]:
        """Return all studies, newest first."""
        return [self._states.get(one.study_id, one) for one in self.folder.states(tuple(self._tasks))]

    def state(self, study_id: str) -> StudyState:
        """Return how far one study is."""
        return self._states.get(study_id) or self.folder.state(study_id, tuple(self._tasks))

    async def remove(self, study_id: str) -> StudyState | None:
        """Cancel a study that is under way and return its state; delete one that has ended."""
        task = self._tasks.get(study_id)
        if task is None:
            await run_in_threadpool(self.folder.delete, study_id)
            return None
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        return self.state(study_id)

    async def find_programs(self, question: ProgramQuestion) -> ProgramAnswer:
        """Return the best step programs; raise `ValueError` with a sentence where there are none."""
        found = await self._answer(FindPrograms(question))
        if not isinstance(found, ProgramsFound):
            raise TypeError(f"The worker answered {type(found).__name__}.")
        return found.answer

    async def compare(self, question: CompareSite) -> Comparison:
        """Return what modes and deadbands are worth at a site."""
        found = await self._answer(question)
        if not isinstance(found, SiteCompared):
            raise TypeError(f"The worker answered {type(found).__name__}.")
        return found.comparison

    async def add_weather(self, name: str, content: bytes) -> WeatherFile:
        """Keep a weather file if it can be used; raise `ValueError` with a sentence if not."""
        name = weather_name(name)
        new = await run_in_threadpool(self.folder.put_weather, name, content)
        try:
            seen = await self._answer(CheckWeather(str(new)))
            if not isinstance(seen, WeatherSeen):
                raise TypeError(f"The worker answered {type(seen).__name__}.")
            return await run_in_threadpool(self.folder.accept_weather, name, new, seen)
        finally:
            new.unlink(missing_ok=True)

    async def close(self) -> None:
        """Cancel everything that is under way."""
        tasks = tuple(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _run(self, state: StudyState, job: WorkOut) -> StudyState:
        """Work out one study and return how it ended."""
        try:
            async with self._turn, asyncio.timeout(LONGEST.total_seconds()):
                return await self._work(state, job)
        except TimeoutError:
            return replace(state, status=StudyStatus.FAILED, message=TOO_LONG)

    def _ended(self, state: StudyState, task: asyncio.Task[StudyState]) -> None:
        """Keep how a study ended, even if it was cancelled before it began."""
        del self._tasks[state.study_id], self._states[state.study_id]
        if task.cancelled():
            ended = replace(state, status=StudyStatus.CANCELLED)
        elif error := task.exception():
            log.error("study failed", study=state.study_id, error=repr(error))
            ended = replace(state, status=StudyStatus.FAILED, message=DIED)
        else:
            ended = task.result()
        with suppress(OSError, StudyUnknown):
            self.folder.note(ended)

    async def _work(self, state: StudyState, job: WorkOut) -> StudyState:
        running = replace(state, status=StudyStatus.RUNNING)
        self._states[state.study_id] = running
        async with aclosing(_told(job)) as lines:
            async for told in lines:
                match told:
                    case Began(done, of, doing):
                        running = replace(running, done=done, of=of, doing=doing)
                        self._states[state.study_id] = running
                    case Studied(result):
                        await run_in_threadpool(self.folder.keep, state.study_id, result)
                        return replace(running, status=StudyStatus.DONE, done=running.of, doing="")
                    case Refused(reason):
                        return replace(running, status=StudyStatus.FAILED, message=reason)
                    case _:
                        break
        return replace(running, status=StudyStatus.FAILED, message=DIED)

    async def _answer(self, job: Job) -> Told:
        """Return the one answer to a question; raise `ValueError` for a refusal."""
        need("studies")
        if self._questions >= MOST_QUESTIONS:
            raise Busy(TOO_BUSY)
        self._questions += 1
        try:
            async with asyncio.timeout(LONGEST_QUESTION.total_seconds()), aclosing(_told(job)) as lines:
                async for told in lines:
                    if isinstance(told, Refused):
                        raise ValueError(told.reason)
                    return told
        except TimeoutError as error:
            raise Busy(TOO_BUSY) from error
        finally:
            self._questions -= 1
        raise Busy(TOO_BUSY)


async def _told(job: Job) -> AsyncGenerator[Told, None]:
    """Yield what a new worker tells about a job, and end it in any case."""
    async with _worker() as process:
        if process.stdin is None or process.stdout is None:
            raise TypeError("A worker has pipes.")
        process.stdin.write(JOB.dump_json(job) + b"\n")
        process.stdin.close()
        async for line in process.stdout:
            yield TOLD.validate_json(line)


@asynccontextmanager
async def _worker() -> AsyncIterator[asyncio.subprocess.Process]:
    process = await asyncio.create_subprocess_exec(
        *own_process(WORKER),
        stdin=asyncio.subprocess.PIPE,
        stdout=asyncio.subprocess.PIPE,
        limit=LONGEST_LINE,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        if process.returncode is None:
            with suppress(ProcessLookupError):
                process.kill()
        await process.wait()
