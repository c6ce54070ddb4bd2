"""What every page says of who looks at it."""

from dataclasses import dataclass, field
from datetime import datetime


@dataclass(frozen=True, slots=True)
class Who:
    """Who looks at a page: the words in the header, and what the page's scripts send along."""

    name: str = ""
    roles: str = ""
    signed_in: bool = False
    is_kiosk: bool = False
    this_computer: bool = False
    may: frozenset[str] = field(default_factory=frozenset)
    csrf: str = ""
    stop_ticket: str = ""
    stepped_until: datetime | None = None
    actor: str = ""
    via: str = ""
    weight: int = 0
