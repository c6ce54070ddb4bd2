"""What came at once is done one by one, and everybody else has a turn in between."""

import asyncio

from app.base.turnstile import Turnstile


async def turns(count: int = 10) -> None:
    for _ in range(count):
        await asyncio.sleep(0)


async def test_between_two_of_them_everybody_else_has_a_turn() -> None:
    done: list[str] = []
    turnstile = Turnstile()
    for name in "abc":
        turnstile.add(lambda name=name: done.append(name))  # type: ignore[misc]
    assert (len(turnstile), done) == (3, [])

    async def other() -> None:
        for number in range(3):
            done.append(str(number))
            await asyncio.sleep(0)

    await other()
    assert done == ["0", "a", "1", "b", "2", "c"]
    assert len(turnstile) == 0


async def test_it_begins_again_after_it_was_empty_and_after_an_error() -> None:
    done: list[int] = []
    turnstile, errors = Turnstile(), []
    asyncio.get_running_loop().set_exception_handler(lambda _, context: errors.append(context["exception"]))
    for number in range(3):
        turnstile.add(lambda number=number: done.append(1 // number))  # type: ignore[misc]
    await turns()
    assert [type(error) for error in errors] == [ZeroDivisionError]
    assert done == [1, 0]
    turnstile.add(lambda: done.append(7))
    await turns()
    assert (done, len(turnstile)) == ([1, 0, 7], 0)


async def test_what_adds_more_work_is_not_done_twice() -> None:
    done: list[str] = []
    turnstile = Turnstile()

    def first() -> None:
        done.append("first")
        turnstile.add(lambda: done.append("second"))

    turnstile.add(first)
    await turns()
    assert done == ["first", "second"]


async def test_while_it_is_held_everything_waits_and_nothing_is_done_twice() -> None:
    done: list[str] = []
    turnstile = Turnstile()
    turnstile.add(lambda: done.append("a"))
    turnstile.hold(60.0)
    turnstile.add(lambda: done.append("b"))
    await turns()
    assert (done, len(turnstile)) == ([], 2)
    turnstile.release()
    turnstile.release()
    await turns()
    assert (done, len(turnstile)) == (["a", "b"], 0)


async def test_it_is_held_no_longer_than_was_said() -> None:
    done, gone_on = [], asyncio.Event()
    turnstile = Turnstile()
    turnstile.hold(60.0)
    turnstile.hold(0.001)
    turnstile.add(lambda: done.append("a"))
    turnstile.add(gone_on.set)
    assert done == []
    await gone_on.wait()
    assert done == ["a"]
