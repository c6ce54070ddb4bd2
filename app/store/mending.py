"""A stored tracker with values that do not fit: each gives way to the usual one, and every change is told."""

import json
from dataclasses import replace
from typing import Any

from pydantic import TypeAdapter, ValidationError

from app.tracker.config import TrackerConfig
from app.tracker.memory import RejectedSetting, TrackerMemory, TrackerState

MOST_MENDED = 50
LONGEST_TOLD = 60
OF_THE_CONFIG = ("config",)
Place = tuple[str | int, ...]

_tracker: TypeAdapter[TrackerState] = TypeAdapter(TrackerState)


def mended(text: str, tracker_id: str) -> TrackerState | None:
    """Return the tracker with usual values where the stored ones do not fit, None where that cannot be.

    Such a tracker neither tracks nor believes its zero, until somebody has looked at what was rejected.
    """
    try:
        document = json.loads(text)
    except ValueError:
        return None
    if not isinstance(document, dict) or not isinstance(document.get("config"), dict):
        return None
    usual = _tracker.dump_python(
        TrackerState(TrackerConfig(tracker_id, tracker_id), TrackerMemory()), mode="json"
    )
    rejected: list[RejectedSetting] = []
    for _ in range(MOST_MENDED):
        try:
            found = _tracker.validate_json(json.dumps(document))
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            change = _give_way(document, usual, first["loc"], first["msg"].removeprefix("Value error, "))
            if change is None:
                return None
            rejected.append(change)
        else:
            return _halted(found, tuple(rejected)) if found.config.tracker_id == tracker_id else None
    return None


def _halted(found: TrackerState, rejected: tuple[RejectedSetting, ...]) -> TrackerState:
    if not rejected:
        return found
    memory = replace(
        found.memory,
        rejected=rejected,
        tracking_on=False,
        home=None,
        home_lost="stored settings were rejected at the start.",
    )
    return replace(found, memory=memory)


def _give_way(document: dict[str, Any], usual: Any, where: Place, why: str) -> RejectedSetting | None:
    """Put the usual value where one does not fit; return what changed, None where there is no usual one."""
    place = _known(document, usual, where)
    if len(place) < 2 or place == OF_THE_CONFIG:
        return None
    *path, last = place
    holder, usual_holder = _at(document, path), _at(usual, path)
    if not isinstance(holder, dict) or not isinstance(usual_holder, dict) or last not in usual_holder:
        return None
    stored = holder.get(str(last), "missing")
    holder[str(last)] = usual_holder[last]
    name = " ".join(str(part) for part in place if part != "config").replace("_", " ")
    return RejectedSetting(name, _told(stored), _told(usual_holder[last]), why)


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


def _told(value: object) -> str:
    text = value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= LONGEST_TOLD else f"{text[:LONGEST_TOLD]}…"
