"""The present state as JSON text: each tracker is rendered once a language, and only when it has changed."""

from dataclasses import replace
from datetime import timedelta
from itertools import takewhile
from typing import Any

import orjson

from app.alarms.urgency import own_headline
from app.base.clock import Clock
from app.link.messages import Update
from app.tracker.state.snapshot import SiteSnapshot, Snapshot
from app.web.http.build_id import edition
from app.web.languages.catalogue import catalogue_of
from app.web.languages.live_texts import in_language
from app.web.live.viewers import Message, Wanted
from app.web.services.narrowed import narrowed_site

TOGETHER = timedelta(milliseconds=100)
LOST = Message("machine_lost", '{"type":"machine_lost"}')


class States:
    """What the machine told last. `revision` counts what was told: who has one is sent what changed since."""

    def __init__(self, clock: Clock) -> None:
        self.site: SiteSnapshot | None = None
        self.revision = 0
        self._clock = clock
        self._build = edition()
        self._heard_at = self._rendered_at = clock.now()
        self._trackers: dict[str, Snapshot] = {}
        self._changed: dict[str, int] = {}
        self._all_new = self._news = 0
        self._texts: dict[str, dict[tuple[str, bool], orjson.Fragment]] = {}
        self._messages: dict[tuple[Wanted, int | None], Message] = {}

    def take(self, update: Update) -> None:
        """Take an update; all that it does not name as changed is kept as it was rendered."""
        self.revision += 1
        before, self.site = self.site, update.snapshot
        self._heard_at = self._clock.now()
        self._messages.clear()
        all_new = update.after is None or update.arrivals or before is None
        if all_new:
            self._trackers, self._changed = {}, {}
            self._texts.clear()
            self._all_new = self.revision
        if all_new or not update.same_alarms or _told_at_once(before) != _told_at_once(self.site):
            self._news = self.revision
        for tracker in update.snapshot.trackers if all_new else update.changed:
            self._renew(tracker)

    def _renew(self, tracker: Snapshot) -> None:
        tracker_id = tracker.tracker_id
        self._trackers[tracker_id] = tracker
        self._changed.pop(tracker_id, None)
        self._changed[tracker_id] = self.revision
        self._texts[tracker_id] = {}

    def lose(self) -> None:
        """Forget everything: the machine is not there."""
        self.site = None
        self._messages.clear()

    def is_news(self, wanted: Wanted, since: int | None) -> bool:
        """Return whether a reader who has the revision `since` is to be told at once."""
        if wanted.tracker_id is None or since is None or self.site is None:
            return True
        return max(self._news, self._changed.get(wanted.tracker_id, 0)) > since

    def message(self, wanted: Wanted, since: int | None, mark: str) -> Message:
        """Return the present state, the same text for all who want and have the same.

        Who wants the whole site and has a revision of it is sent the trackers that changed since.
        """
        now = self._clock.now()
        if now - self._rendered_at > TOGETHER:
            self._messages.clear()
        if not self._messages:
            self._rendered_at = now
        if wanted.tracker_id is not None or wanted.always_whole or (since or 0) < self._all_new:
            since = None
        alike = replace(wanted, kinds=frozenset()), since
        if alike not in self._messages:
            self._messages[alike] = self._render(*alike, mark)
        return self._messages[alike]

    def _render(self, wanted: Wanted, since: int | None, mark: str) -> Message:
        site = self.site
        if site is None:
            return LOST
        catalogue = catalogue_of(wanted.language)
        seen = site if wanted.trackers is None else narrowed_site(site, wanted.trackers)
        head = orjson.loads(in_language(catalogue, replace(seen, trackers=())))
        chosen, allowed = self._chosen(wanted, since), wanted.trackers
        trackers = [self._text(one, wanted) for one in chosen if allowed is None or one in allowed]
        state: dict[str, Any] = {
            "type": "state",
            "rev": site.sequence,
            "boot": site.boot_id,
            "build": self._build,
            "at": site.at,
            "age_ms": round((self._clock.now() - self._heard_at) / timedelta(milliseconds=1)),
            "part": since is not None,
            "snapshot": {**head, "trackers": trackers},
        }
        return Message("snapshot", orjson.dumps(state).decode(), mark, self.revision)

    def _chosen(self, wanted: Wanted, since: int | None) -> list[str]:
        if wanted.tracker_id is not None:
            return [wanted.tracker_id] if wanted.tracker_id in self._trackers else []
        if since is None:
            return [one.tracker_id for one in self.site.trackers] if self.site else []
        newest_first = reversed(self._changed.items())
        return [tracker_id for tracker_id, _ in takewhile(lambda one: one[1] > since, newest_first)]

    def _text(self, tracker_id: str, wanted: Wanted) -> orjson.Fragment:
        """Return a tracker as text; who looks at it alone is told what may be asked, and all messages."""
        asked = wanted.tracker_id is not None
        key, texts = (wanted.language, asked), self._texts[tracker_id]
        if key not in texts:
            tracker = self._trackers[tracker_id]
            shown = tracker if asked else _in_short(tracker)
            texts[key] = orjson.Fragment(in_language(catalogue_of(wanted.language), shown))
        return texts[key]


def _in_short(tracker: Snapshot) -> Snapshot:
    """Return a tracker as those are told who look at all of them."""
    first = own_headline(tracker)
    return replace(tracker, actions={}, messages=() if first is None else (first,))


def _told_at_once(site: SiteSnapshot | None) -> object:
    """Return what every page is told at once when it changes; all else goes with the next state."""
    if site is None:
        return None
    return site.site_name, site.location, site.time_zone, site.clock.trusted, site.clock.set_at
