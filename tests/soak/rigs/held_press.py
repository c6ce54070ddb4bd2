"""What happened during one press, told when its axis did not turn: who was late, and by how much."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple, Self
from uuid import uuid4

from tests.e2e.product import Product
from tests.e2e.socket_page import Answer

SERVICES = ("web", "controller")


class Spent(NamedTuple):
    """How long a process had a processor, and how long it was ready and had none."""

    ran_ms: float
    waited_ms: float

    @classmethod
    def by(cls, process_id: int) -> Self:
        """Return it as the kernel counts it since the process began."""
        ran_ns, waited_ns, _ = Path(f"/proc/{process_id}/schedstat").read_text().split()
        return cls(int(ran_ns) / 1e6, int(waited_ns) / 1e6)


@dataclass
class Press:
    """One press: when its heartbeats left, and what the services had of the processors from then on."""

    product: Product
    name: str
    press_id: str = field(default_factory=lambda: uuid4().hex)
    sent_s: list[float] = field(default_factory=list)
    services: dict[str, list[Spent]] = field(default_factory=dict)

    def sent(self, at_s: float) -> None:
        """Note one heartbeat."""
        self.sent_s.append(at_s)
        self.look()

    def look(self) -> None:
        """Note what the services have had of the processors until now."""
        for service in SERVICES:
            spent = Spent.by(self.product.starts(service)[-1])
            self.services.setdefault(service, []).append(spent)

    def longest_gap_s(self, looked_s: float) -> float:
        """Return the longest time without a heartbeat until it was looked."""
        return max(later - former for former, later in pairwise((*self.sent_s, looked_s)))

    def tell(self, looked_s: float, answers: Sequence[Answer], ends: Sequence[Answer]) -> str:
        """Return what happened until it was looked whether the axis turns, in milliseconds of the press."""
        begun_s = self.sent_s[0]
        heard = ", ".join(f"{_ms(answer.at_s - begun_s)} {answer.text}" for answer in answers)
        ended = ", ".join(f"{_ms(end.at_s - begun_s)} {end.text}" for end in ends if end.at_s >= begun_s)
        return (
            f"{self.name}, in ms: heartbeats left at {', '.join(_ms(at - begun_s) for at in self.sent_s)}; "
            f"answers came at {heard or 'never'}; looked at {_ms(looked_s - begun_s)}; "
            f"ended: {ended or 'not told'}; {'; '.join(self._spent(service) for service in SERVICES)}"
        )

    def _spent(self, service: str) -> str:
        """Return what a service had of the processors between each two heartbeats."""
        each = (
            f"{later.ran_ms - former.ran_ms:.0f}/{later.waited_ms - former.waited_ms:.0f}"
            for former, later in pairwise(self.services[service])
        )
        return f"{service} ran/waited for a processor {' '.join(each)}"


def _ms(seconds: float) -> str:
    return f"{seconds * 1000.0:.0f}"
