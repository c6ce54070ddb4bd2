"""A key stands for one command: repeated it is answered as the first was, with another body it is refused."""

import pytest

from app.link.messages import Order
from app.site.repeats import Repeats
from app.tracker.commands import CommandRejected, Park, Track
from app.tracker.snapshot import SiteSnapshot
from tests.fakes import FakeMachine


def park(tracker_id: str = "T1") -> Order:
    return Order(Park(), "anna", tracker_id, key="k1")


@pytest.mark.parametrize(
    "other", [Order(Track(), "anna", "T1", key="k1"), park("T2")], ids=["kind", "tracker"]
)
async def test_a_key_that_is_used_again_for_something_else_is_refused_and_nothing_is_done(
    other: Order,
) -> None:
    done: list[Order] = []
    answer = FakeMachine().emit()

    async def carry_out(order: Order) -> SiteSnapshot:
        done.append(order)
        return answer

    repeats = Repeats()
    assert await repeats.once(park(), carry_out) is answer
    assert await repeats.once(park(), carry_out) is answer
    with pytest.raises(CommandRejected) as refused:
        await repeats.once(other, carry_out)
    (reason,) = refused.value.reasons
    assert reason.code == "key_reused"
    assert reason.message == "This idempotency key was used for another command, so nothing was done."
    assert len(done) == 1
