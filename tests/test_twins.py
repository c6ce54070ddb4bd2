"""Records in two copies: the newest whole one counts, whatever was torn."""

from pathlib import Path

import pytest

from app.base.twins import HEAD, Twins

ROOM = 20
COPY = HEAD.size + ROOM


def of(path: Path) -> Twins:
    twins = Twins(path, ROOM)
    twins.read()
    return twins


def test_the_newest_of_every_record_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "folder" / "kept"
    twins = of(path)
    for number, content in ((0, b"a"), (2, b"b"), (0, b"c"), (0, b"d" * ROOM)):
        twins.write(number, content)
    assert Twins(path, ROOM).read() == [b"d" * ROOM, None, b"b"]
    assert path.stat().st_size <= 6 * COPY
    assert path.stat().st_mode & 0o777 == 0o600


def test_what_cannot_be_read_is_as_if_it_were_not_there(tmp_path: Path) -> None:
    assert Twins(tmp_path / "none", ROOM).read() == []
    (tmp_path / "kept").mkdir()
    assert Twins(tmp_path / "kept", ROOM).read() == []


@pytest.mark.fault(84)
@pytest.mark.parametrize("torn_at", range(COPY))
def test_a_torn_copy_leaves_the_one_before(tmp_path: Path, torn_at: int) -> None:
    path = tmp_path / "kept"
    twins = of(path)
    for content in (b"first", b"second", b"the third and last.."):
        twins.write(0, content)
    stored = bytearray(path.read_bytes())
    before = stored[COPY + torn_at :]
    stored[COPY + torn_at :] = bytes(one ^ 0x5A for one in before)
    path.write_bytes(stored)
    assert of(path).read() == [b"second"]
    again = of(path)
    again.write(0, b"fourth")
    assert of(path).read() == [b"fourth"]


def test_a_later_life_goes_on_counting(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    for content in (b"one", b"two", b"three", b"four", b"five"):
        of(path).write(0, content)
        assert of(path).read() == [content]


def test_a_cut_off_file_and_a_strange_one_are_not_believed(tmp_path: Path) -> None:
    path = tmp_path / "kept"
    path.write_bytes(b"\x01\x02")
    assert of(path).read() == [None]
    path.write_bytes(bytes(5 * COPY))
    assert of(path).read() == [None, None, None]


def test_too_much_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="holds 20 bytes"):
        of(tmp_path / "kept").write(0, b"x" * (ROOM + 1))
