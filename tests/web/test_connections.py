"""How many connections clients hold, by the count alone: shares, what is kept for Stop, who makes room."""

import resource
from dataclasses import dataclass

import pytest

from app.web.http import server
from app.web.http.server import MOST_TOLD, RESERVED, RESERVED_A_CLIENT, Admission, Connections

FAR, OTHER = "192.0.2.7", "192.0.2.8"


@dataclass(eq=False)
class Member:
    """A connection, and whether an answer is under way on it."""

    connections: Connections
    client: str = FAR
    is_idle: bool = False
    admission: Admission = Admission.NOTHING
    hung_up: bool = False

    def join(self) -> Admission:
        self.admission = self.connections.join(self.client, self)
        return self.admission

    def part(self) -> None:
        self.connections.part(self.client, self, self.admission)
        self.admission = Admission.NOTHING

    def hang_up(self) -> None:
        self.hung_up = True
        self.part()


def entered(connections: Connections, count: int, client: str = FAR) -> list[Admission]:
    return [connections.enter(client) for _ in range(count)]


def test_beyond_its_share_a_client_may_stop_and_then_nothing() -> None:
    connections = Connections(most=100, most_a_client=3)
    assert entered(connections, 3) == [Admission.ANYTHING] * 3
    assert entered(connections, RESERVED_A_CLIENT) == [Admission.STOP] * RESERVED_A_CLIENT
    assert entered(connections, 2) == [Admission.NOTHING] * 2
    assert connections.enter(OTHER) is Admission.ANYTHING


def test_beyond_the_total_everybody_may_stop_until_what_is_kept_for_it_is_used_up() -> None:
    connections = Connections(most=4, most_a_client=3)
    assert entered(connections, 3) == [Admission.ANYTHING] * 3
    assert connections.enter(OTHER) is Admission.ANYTHING
    crowd = [connections.enter(f"10.0.0.{number}") for number in range(RESERVED)]
    assert crowd == [Admission.STOP] * RESERVED
    assert connections.enter(OTHER) is Admission.NOTHING


@pytest.mark.parametrize("admission", [Admission.ANYTHING, Admission.STOP])
def test_who_leaves_makes_room_for_one(admission: Admission) -> None:
    connections = Connections(most=100, most_a_client=3)
    entered(connections, 3 + RESERVED_A_CLIENT)
    connections.leave(FAR, Admission.NOTHING)
    assert connections.enter(FAR) is Admission.NOTHING
    for _ in range(2):
        connections.leave(FAR, admission)
    assert entered(connections, 3) == [admission, admission, Admission.NOTHING]


def test_what_is_kept_for_stop_is_counted_to_the_last() -> None:
    connections = Connections(most=100, most_a_client=1)
    entered(connections, 1 + RESERVED_A_CLIENT)
    for _ in range(RESERVED_A_CLIENT - 1):
        connections.leave(FAR, Admission.STOP)
    later = [Admission.STOP] * (RESERVED_A_CLIENT - 1) + [Admission.NOTHING]
    assert entered(connections, RESERVED_A_CLIENT) == later


def test_a_client_of_which_nothing_is_left_is_forgotten() -> None:
    connections = Connections(most=100, most_a_client=1)
    members = [Member(connections) for _ in range(3)]
    assert [one.join() for one in members] == [Admission.ANYTHING, Admission.STOP, Admission.STOP]
    for one in members:
        one.part()
    assert not connections._held
    assert not connections._reserved
    assert not connections._members


def test_the_oldest_connection_without_an_answer_under_way_makes_room() -> None:
    connections = Connections(most=100, most_a_client=3)
    busy, first, second = members = [Member(connections, is_idle=idle) for idle in (False, True, True)]
    assert [one.join() for one in members] == [Admission.ANYTHING] * 3
    late = Member(connections)
    assert late.join() is Admission.ANYTHING
    assert (busy.hung_up, first.hung_up, second.hung_up) == (False, True, False)
    assert Member(connections).join() is Admission.ANYTHING
    assert second.hung_up
    assert not connections._reserved
    assert Member(connections).join() is Admission.STOP, "nobody is idle any more"
    assert connections.enter(OTHER) is Admission.ANYTHING
    first.part()
    assert Member(connections).join() is Admission.STOP, "who was hung up on leaves once"


def test_nobody_makes_room_for_another_client() -> None:
    connections = Connections(most=2, most_a_client=2)
    idle = Member(connections, is_idle=True)
    idle.join()
    Member(connections).join()
    assert Member(connections, OTHER).join() is Admission.STOP
    assert not idle.hung_up


def test_excess_is_told_of_once_until_half_of_the_share_is_free_again() -> None:
    connections = Connections(most=100, most_a_client=5)
    entered(connections, 5)
    assert connections.is_new_excess(FAR)
    assert not connections.is_new_excess(FAR)
    assert connections.is_new_excess(OTHER)
    for _ in range(2):
        connections.release(FAR)
    assert not connections.is_new_excess(FAR), "3 of 5 are held"
    connections.release(FAR)
    assert connections.is_new_excess(FAR)


def test_so_many_clients_are_told_of_and_no_more() -> None:
    connections = Connections(most=1)
    told = [connections.is_new_excess(str(number)) for number in range(MOST_TOLD + 1)]
    assert told == [True] * MOST_TOLD + [False]


@pytest.mark.parametrize(
    ("before", "after", "connections"),
    [
        ((1024, 524_288), (8192, 524_288), 8064),
        ((1024, 4096), (4096, 4096), 3968),
        ((20_000, 524_288), (20_000, 524_288), 19_872),
        ((8192, 8192), (8192, 8192), 8064),
        ((1024, resource.RLIM_INFINITY), (8192, resource.RLIM_INFINITY), 8064),
        ((64, 64), (64, 64), 16),
    ],
)
def test_descriptors_are_asked_for_and_some_are_kept_for_files(
    monkeypatch: pytest.MonkeyPatch, before: tuple[int, int], after: tuple[int, int], connections: int
) -> None:
    limits = {resource.RLIMIT_NOFILE: before}

    def set_limit(which: int, limit: tuple[int, int]) -> None:
        assert limits[which] != limit, "one that is as it was is not set"
        limits[which] = limit

    monkeypatch.setattr(resource, "getrlimit", limits.__getitem__)
    monkeypatch.setattr(resource, "setrlimit", set_limit)
    assert server.reserve_descriptors() == connections
    assert limits == {resource.RLIMIT_NOFILE: after}
