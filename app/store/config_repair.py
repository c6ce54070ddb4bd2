"""A stored tracker or site with values that do not fit: others are used, those accepted last or the usual."""

import json
from dataclasses import replace
from typing import Any, TypeVar

from pydantic import ValidationError

from app.audit.difference import difference
from app.base.adapter import adapter
from app.base.addresses.masking import SECRET_NAMES, masked, without_secrets
from app.base.message import N_, Message, plain, told_of_value
from app.tracker.memory.memory import RejectedSetting, SiteState, TrackerMemory, TrackerState
from app.tracker.settings.config import TrackerConfig

MOST_MENDED = 50
LONGEST_TOLD = 60
OF_THE_CONFIG = ("config",)
BESIDE = N_("The last accepted settings form one set; this setting is not in it.")
NO_TRACKER = N_("The stored data is not a tracker.")
MEMORY = "memory "
Place = tuple[str | int, ...]
Rejected = tuple[RejectedSetting, ...]
T = TypeVar("T")


def mended(text: str, tracker_id: str, accepted: TrackerConfig | None = None) -> TrackerState | None:
    """Return the tracker with other values where the stored ones do not fit, None where that cannot be.

    With `accepted`, the settings that it ran with last, these are used as a whole; without them each value
    that does not fit gives way to the usual one. Such a tracker neither tracks nor believes its zero, until
    somebody has looked at what was rejected.
    """
    document = _document(text)
    stored = None if document is None else document["config"]
    found = None if document is None else _piecewise(json.loads(text), tracker_id)
    if accepted is None or accepted.tracker_id != tracker_id:
        return None if found is None else _halted(*found)
    if found is None:
        why = RejectedSetting(N_("all settings"), _told(text), N_("the last accepted"), NO_TRACKER, True)
        return _halted(TrackerState(accepted, TrackerMemory()), (why,))
    state, rejected = found
    return fallen_back(state, accepted, stored, rejected) if rejected else state


def mended_site(text: str) -> tuple[SiteState, Rejected] | None:
    """Return the site with usual values where the stored ones do not fit, and which; None: it cannot be."""
    usual = adapter(SiteState).dump_python(SiteState(), mode="json")
    document = _object(text)
    found, rejected = (None, ()) if document is None else _fitting(SiteState, document, usual, least=1)
    return None if found is None else (found, rejected)


def fallen_back(
    state: TrackerState,
    accepted: TrackerConfig,
    stored: Any = None,
    rejected: Rejected = (),
    why: str = BESIDE,
) -> TrackerState:
    """Return the tracker with the settings accepted last; each stored value that differs is told.

    `stored` are the settings as they were stored, where they are not those of `state`; `rejected` are the
    values that do not fit, with their reasons; `why` is told of the others.
    """
    told = [one for one in rejected if one.what.startswith(MEMORY)]
    before = adapter(TrackerConfig).dump_python(state.config, mode="json") if stored is None else stored
    old, new = difference(before, adapter(TrackerConfig).dump_python(accepted, mode="json"))
    for path in sorted(old | new):
        name = _name(path.split("."))
        reason = next((one.why for one in rejected if _is_within(name, one.what)), why)
        used = _told(new[path]) if path in new else N_("none")
        told.append(RejectedSetting(name, _told(old.get(path, "missing")), used, plain(reason), True))
    return _halted(replace(state, config=accepted), tuple(told[:MOST_MENDED]))


def _document(text: str) -> dict[str, Any] | None:
    document = _object(text)
    return document if document is not None and isinstance(document.get("config"), dict) else None


def _object(text: str) -> dict[str, Any] | None:
    try:
        document = json.loads(text)
    except ValueError:
        return None
    return document if isinstance(document, dict) else None


def _piecewise(document: dict[str, Any], tracker_id: str) -> tuple[TrackerState, Rejected] | None:
    """Return the tracker with usual values where stored ones do not fit, and which; None: it cannot be."""
    usual = adapter(TrackerState).dump_python(
        TrackerState(TrackerConfig(tracker_id, tracker_id), TrackerMemory()), mode="json"
    )
    found, rejected = _fitting(TrackerState, document, usual, least=2)
    return None if found is None or found.config.tracker_id != tracker_id else (found, rejected)


def _fitting(
    shape: type[T], document: dict[str, Any], usual: Any, *, least: int
) -> tuple[T | None, Rejected]:
    """Return what a document holds with usual values where its own do not fit, and which; None: it cannot be.

    A value gives way that lies at least so deep in the document.
    """
    rejected: list[RejectedSetting] = []
    for _ in range(MOST_MENDED):
        try:
            return adapter(shape).validate_json(json.dumps(document)), tuple(rejected)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            change = _give_way(document, usual, first["loc"], told_of_value(first), least)
            if change is None:
                break
            rejected.append(change)
    return None, ()


def _halted(found: TrackerState, rejected: Rejected) -> TrackerState:
    if not rejected:
        return found
    memory = replace(
        found.memory,
        rejected=rejected,
        tracking_on=False,
        home=None,
        home_lost=N_("stored settings were rejected at the start."),
    )
    return replace(found, memory=memory)


def _give_way(
    document: dict[str, Any], usual: Any, where: Place, why: str, least: int
) -> RejectedSetting | None:
    """Put the usual value where one does not fit; return what changed, None where there is no usual one."""
    place = _known(document, usual, where)
    if len(place) < least or place == OF_THE_CONFIG:
        return None
    *path, last = place
    holder, usual_holder = _at(document, path), _at(usual, path)
    if not isinstance(holder, dict) or not isinstance(usual_holder, dict) or last not in usual_holder:
        return None
    stored = holder.get(str(last), "missing")
    holder[str(last)] = usual_holder[last]
    name = _name([str(part) for part in place if part != "config"])
    shown, why = without_secrets({str(last): stored})[str(last)], _without_secrets_of(stored, why)
    return RejectedSetting(name, _told(shown), _told(usual_holder[last]), plain(why))


def _without_secrets_of(stored: object, why: str) -> str:
    """Return why a value does not fit without the addresses in it that may hold a secret."""
    for name in SECRET_NAMES:
        address = stored.get(name) if isinstance(stored, dict) else None
        if address and isinstance(address, str):
            why = why.replace(address, masked(address))
    return why


def _name(path: list[str]) -> Message:
    return plain(" ".join(path).replace("_", " "))


def _is_within(name: str, other: str) -> bool:
    """Return whether one of two settings is the other, or a part of it."""
    return f"{name} ".startswith(f"{other} ") or f"{other} ".startswith(f"{name} ")


def _known(document: Any, usual: Any, where: Place) -> Place:
    """Return the place as far as there are settings of these names; the word of a choice is no place."""
    value, usual_value, place = document, usual, []
    for part in where:
        is_setting = isinstance(usual_value, dict) and part in usual_value
        if not isinstance(value, dict) or not (part in value or is_setting):
            break
        place.append(part)
        if part not in value:
            break
        value, usual_value = value[part], usual_value[part] if is_setting else None
    return tuple(place)


def _at(value: Any, path: list[str | int]) -> Any:
    for part in path:
        if not isinstance(value, dict) or part not in value:
            return None
        value = value[part]
    return value


def _told(value: object) -> Message:
    text = value if isinstance(value, str) else json.dumps(value)
    return plain(text if len(text) <= LONGEST_TOLD else f"{text[:LONGEST_TOLD]}…")
