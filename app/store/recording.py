"""Recordings in their tables: samples come in as small blocks, and are packed once there are 900 of them."""

from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime, timedelta
from typing import Any

from sqlalchemy import Connection, Select, delete, func, insert, select, update

from app.base.logs import get_logger
from app.store import tables
from app.store.chunks import CHUNK_FRAMES, ChunkDamaged, decode, decode_all, encode_all
from app.store.documents import RECORDING, plain
from app.store.store import Recorded
from app.tracker.memory.recording import Frames, RecordingInfo

IDS_AT_ONCE = 500
RUNS = tables.recordings.c.ended_at.is_(None)
BLOCK = ("first_elapsed_s", "last_elapsed_s", "frame_count", "frames")

Block = dict[str, Any]
"""The columns of some frames, packed: those of `BLOCK`, the same in both tables."""

log = get_logger()


def heads() -> Select[Any]:
    """Return the query of the heads of recordings; samples that wait to be packed count."""
    columns, blocks = tables.recordings.c, tables.sample_blocks.c
    count = func.sum(blocks.frame_count).label("frames")
    waiting = select(blocks.recording_id, count).group_by(blocks.recording_id).subquery()
    counted = (columns.frame_count + func.coalesce(waiting.c.frames, 0)).label("frame_count")
    return select(
        columns.recording_id, columns.ended_at, columns.outcome, counted, columns.document
    ).select_from(tables.recordings.outerjoin(waiting, waiting.c.recording_id == columns.recording_id))


def stored_frames(
    connection: Connection, recording_id: str, begin_s: float, end_s: float | None
) -> list[bytes]:
    """Return what holds the frames of a range, in order: packed chunks, then the blocks that wait."""
    found: list[bytes] = []
    for table, order in ((tables.chunks, "position"), (tables.sample_blocks, "number")):
        columns = table.c
        query = select(columns.frames).where(
            columns.recording_id == recording_id, columns.last_elapsed_s >= begin_s
        )
        if end_s is not None:
            query = query.where(columns.first_elapsed_s <= end_s)
        found.extend(connection.execute(query.order_by(columns[order])).scalars())
    return found


def insert_head(connection: Connection, info: RecordingInfo, frame_count: int = 0) -> None:
    """Add the head of a recording."""
    connection.execute(
        insert(tables.recordings).values(
            recording_id=info.recording_id,
            kind=info.kind,
            tracker_id=info.tracker_id,
            began_at=info.began_at,
            ended_at=info.ended_at,
            outcome=plain(info.outcome),
            frame_count=frame_count,
            document=RECORDING.write(info),
        )
    )


def insert_chunks(connection: Connection, recording_id: str, blocks: Sequence[Block]) -> None:
    """Add packed chunks behind those that a recording has."""
    columns = tables.chunks.c
    last = select(func.coalesce(func.max(columns.position), -1)).where(columns.recording_id == recording_id)
    first = connection.execute(last).scalar_one() + 1
    rows = [
        {"recording_id": recording_id, "position": position, **one}
        for position, one in enumerate(blocks, first)
    ]
    if rows:
        connection.execute(insert(tables.chunks), rows)


def block(packed: bytes) -> Block:
    """Return the columns of packed frames."""
    frames = decode(packed)
    elapsed_s = frames.column("elapsed_s").round(3)
    values = (float(elapsed_s.min()), float(elapsed_s.max()), len(frames), packed)
    return dict(zip(BLOCK, values, strict=True))


def keep(connection: Connection, recorded: Recorded) -> None:
    """Keep what recordings gained; samples of one that does not run are left out, and logged."""
    began = [info.recording_id for info in recorded.begun]
    present = _present(connection, began)
    for info in recorded.begun:
        if info.recording_id not in present:
            insert_head(connection, info)
    running = _present(connection, recorded.samples, RUNS)
    for recording_id in recorded.samples.keys() - running:
        log.error("samples_refused", recording=recording_id, reason="The recording does not run.")
    append(connection, {one: frames for one, frames in recorded.samples.items() if one in running})
    for recording_id, ended_at, outcome in recorded.ended:
        close(connection, recording_id, ended_at, outcome)


def is_open(connection: Connection, recording_id: str) -> bool:
    """Return whether a recording runs."""
    return bool(_present(connection, [recording_id], RUNS))


def append(connection: Connection, samples: Mapping[str, Frames]) -> None:
    """Add samples to running recordings; those that have enough of them are packed."""
    rows = [
        {"recording_id": recording_id, **block(packed)}
        for recording_id, frames in samples.items()
        for packed in _encoded(recording_id, frames)
    ]
    if not rows:
        return
    connection.execute(insert(tables.sample_blocks), rows)
    columns = tables.sample_blocks.c
    full = func.sum(columns.frame_count) >= CHUNK_FRAMES
    enough = select(columns.recording_id).group_by(columns.recording_id).having(full)
    for recording_id in connection.execute(enough).scalars().all():
        pack(connection, recording_id)


def close(connection: Connection, recording_id: str, ended_at: datetime, outcome: str) -> bool:
    """Pack what waits and close a recording; return whether it ran."""
    pack(connection, recording_id, everything=True)
    columns = tables.recordings.c
    mine = columns.recording_id == recording_id, RUNS
    closed = update(tables.recordings).where(*mine).values(ended_at=ended_at, outcome=plain(outcome))
    return connection.execute(closed).rowcount == 1


def pack(connection: Connection, recording_id: str, *, everything: bool = False) -> None:
    """Turn the blocks of a recording into chunks of 900 frames; the rest waits, or makes the last chunk."""
    columns = tables.sample_blocks.c
    mine = columns.recording_id == recording_id
    query = select(*(columns[name] for name in BLOCK)).where(mine).order_by(columns.number)
    waiting = [dict(row) for row in connection.execute(query).mappings()]
    if not waiting:
        return
    chunks = _packed(recording_id, waiting)
    rest = chunks.pop() if not everything and chunks[-1]["frame_count"] < CHUNK_FRAMES else None
    connection.execute(delete(tables.sample_blocks).where(mine))
    insert_chunks(connection, recording_id, chunks)
    if rest is not None:
        connection.execute(insert(tables.sample_blocks).values(recording_id=recording_id, **rest))
    head = tables.recordings
    grown = head.c.frame_count + sum(one["frame_count"] for one in chunks)
    connection.execute(update(head).where(head.c.recording_id == recording_id).values(frame_count=grown))


def last_frame_at(connection: Connection, info: RecordingInfo) -> datetime | None:
    """Return when the last packed frame of a recording was taken, None without one."""
    columns = tables.chunks.c
    last = select(func.max(columns.last_elapsed_s)).where(columns.recording_id == info.recording_id)
    last_s = connection.execute(last).scalar_one()
    return None if last_s is None else info.began_at + timedelta(seconds=last_s)


def _present(connection: Connection, ids: Iterable[str], *wanted: Any) -> set[str]:
    """Return which of these recordings there are, as far as they are wanted."""
    columns, asked = tables.recordings.c, list(ids)
    found: set[str] = set()
    for begin in range(0, len(asked), IDS_AT_ONCE):
        some = columns.recording_id.in_(asked[begin : begin + IDS_AT_ONCE])
        found.update(connection.execute(select(columns.recording_id).where(some, *wanted)).scalars())
    return found


def _encoded(recording_id: str, frames: Frames) -> list[bytes]:
    """Return frames packed; those that cannot be are left out, and logged, so that all others are kept."""
    try:
        return encode_all(frames)
    except ValueError as error:
        log.error("samples_refused", recording=recording_id, reason=str(error))
        return []


def _packed(recording_id: str, waiting: list[Block]) -> list[Block]:
    """Return blocks as chunks of 900 frames; where one is damaged all stay as they are."""
    try:
        return [block(packed) for packed in encode_all(decode_all([one["frames"] for one in waiting]))]
    except ChunkDamaged as error:
        log.error("samples_not_packed", recording=recording_id, reason=str(error))
        return waiting
