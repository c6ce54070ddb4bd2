"""What is asked about a data folder before and after an upgrade, and whether it is all still there."""

import hashlib
import math
from typing import Any

import httpx

from tests.golden.databases.folders import NAME, PASSWORD
from tests.patience import PATIENCE_S

SITE_SAYS = ("site_name", "location", "time_zone")
STEP_SAYS = ("name", "confirmed_at", "confirmed_by")
SHOW_SAYS = ("show_id", "tracker_id", "start", "end", "duration_s", "mode", "orientation", "algorithm")
PLAIN = (
    "/api/v1/trackers",
    "/api/v1/users",
    "/api/v1/tokens",
    "/api/v1/site/weather/windows",
    "/api/v1/site/notifications",
    "/api/v1/journal?limit=1000",
    "/api/v1/alarms/history?limit=1000",
    "/api/v1/audit?limit=1000",
    "/api/v1/audit/access?limit=1000",
    "/api/v1/records",
)


def signed_in(url: str) -> httpx.Client:
    """Return a browser in which the administrator has signed in."""
    browser = httpx.Client(base_url=url, timeout=PATIENCE_S, headers={"Origin": url})
    answer = browser.post("/api/v1/session", json={"name": NAME, "password": PASSWORD})
    assert answer.status_code == 204, answer.text
    return browser


def asked(browser: httpx.Client, show: str) -> dict[str, Any]:
    """Return the answers about everything that is to be kept, by their addresses."""

    def get(path: str) -> Any:
        answer = browser.get(path)
        assert answer.status_code == 200, f"{path}: {answer.text}"
        told = answer.json()
        return told["items"] if isinstance(told, dict) and {"items", "next"} <= set(told) else told

    site, plan = get("/api/v1/site"), get(show)
    told = {path: get(path) for path in PLAIN}
    told["/api/v1/site/horizon"] = {"points": get("/api/v1/site/horizon")["points"]}
    told["/api/v1/site"] = {name: site[name] for name in SITE_SAYS}
    told[show] = {name: plan[name] for name in SHOW_SAYS}
    for tracker in told["/api/v1/trackers"]:
        place = f"/api/v1/trackers/{tracker['tracker_id']}/commissioning"
        told[place] = [{name: step[name] for name in STEP_SAYS} for step in get(place)]
    told |= _of_records(browser, told["/api/v1/records"])
    ended = [one for one in get("/api/v1/recordings") if one["ended_at"]]
    told["/api/v1/recordings"] = ended
    for one in ended:
        path = f"/api/v1/recordings/{one['recording_id']}/samples?points=50"
        told[path] = get(path)
    return told


def _of_records(browser: httpx.Client, heads: list[dict[str, Any]]) -> dict[str, Any]:
    """Return the documents and photos of signed records by their digests, as they are read."""
    told: dict[str, Any] = {}
    for head in heads:
        path = f"/api/v1/records/{head['number']}"
        told[path] = {"sha256": _digest(browser.get(path))}
        assert browser.get(f"{path}?format=html").is_success
        photos = browser.get(f"{path}/photos").json()["items"]
        told[f"{path}/photos"] = photos
        for photo in photos:
            place = f"/api/v1/record-photos/{photo['number']}"
            told[place] = {"sha256": _digest(browser.get(place))}
    return told


def _digest(answer: httpx.Response) -> str:
    assert answer.is_success, answer.text
    return hashlib.sha256(answer.content).hexdigest()


def lost(before: Any, after: Any, where: str = "") -> list[str]:
    """Return where something that was told before is told no more, or otherwise; more may be told."""
    if isinstance(before, dict) and isinstance(after, dict):
        return [
            one
            for key, value in before.items()
            for one in (lost(value, after[key], f"{where}/{key}") if key in after else [f"{where}/{key}"])
        ]
    if isinstance(before, list) and isinstance(after, list):
        if before and isinstance(before[0], dict):
            kept = (any(not lost(one, other) for other in after) for one in before)
            return [f"{where}[{number}]" for number, is_kept in enumerate(kept) if not is_kept]
        if len(before) == len(after):
            pairs = enumerate(zip(before, after, strict=True))
            return [one for number, (a, b) in pairs for one in lost(a, b, f"{where}[{number}]")]
    if isinstance(before, float) and isinstance(after, int | float):
        return [] if math.isclose(before, after, rel_tol=1e-9, abs_tol=1e-9) else [where]
    return [] if before == after else [where]
