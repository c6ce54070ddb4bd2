"""Details over the link: of a field of trackers only those are sent that are not what was sent last."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

from app.link.codec import Detailed, Details
from app.link.messages import SiteDetail, TrackerDetail

MOST_AT_ONCE = 20


class Sent:
    """What one panel was sent; the machine tells details that have not changed as the same objects."""

    def __init__(self) -> None:
        self._trackers: dict[str, TrackerDetail] = {}

    def parts(self, detail: SiteDetail) -> Iterator[Details]:
        """Yield what the panel has to be told before it is answered."""
        new = {name: one for name, one in detail.trackers.items() if self._trackers.get(name) is not one}
        self._trackers = detail.trackers
        rest = iter(new.items())
        while part := dict(islice(rest, MOST_AT_ONCE)):
            yield Details(part)


def answer(number: int, detail: SiteDetail) -> Detailed:
    """Return the answer for a panel that was told all parts."""
    return Detailed(number, replace(detail, trackers={}), tuple(detail.trackers))


class Received:
    """What one panel was sent, at its end of the link."""

    def __init__(self) -> None:
        self._trackers: dict[str, TrackerDetail] = {}

    def take(self, part: Details) -> None:
        """Take what was told before an answer."""
        self._trackers |= part.trackers

    def whole(self, answer: Detailed) -> SiteDetail:
        """Return the whole; raise `KeyError` if the link was down since the answer."""
        trackers = {name: self._trackers[name] for name in answer.tracker_ids}
        return replace(answer.detail, trackers=trackers)
