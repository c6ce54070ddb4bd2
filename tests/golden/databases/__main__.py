"""Makes the data folder of a version: `python -m tests.golden.databases VERSION [--program FOLDER]`.

The program of that version is served and driven over its API as an operator would: users, a site with two
trackers that are set up, a signed record with a photo, a show that ran and one that is planned, an alarm.
`FOLDER` is a checkout of it; without one it is this one.
"""

import argparse
import io
import os
import sqlite3
import sys
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import httpx
from PIL import Image

from tests.e2e.integrator import SAMSUN, Integrator, Refused
from tests.e2e.product import Product
from tests.golden.databases.folders import HERE, NAME, PASSWORD, Folder
from tests.golden.databases.questions import asked, signed_in
from tests.patience import until as eventually

ROOT = HERE.parents[2]
RAN = {"start": "2027-06-21T10:00:00+03:00", "end": "2027-06-21T12:00:00+03:00", "duration_s": 30}
PLANNED = {"start": "2027-06-21T08:00:00+03:00", "end": "2027-06-21T17:00:00+03:00", "duration_s": 240}
FIRST = {"deadband_deg": 0.75, "park": {"azimuth_deg": 140.0, "elevation_deg": 30.0}, "name": "North field"}
SECOND = {"algorithm": "spa", "night": "park", "azimuth": {"maximum_deg": 250.0}, "refraction": False}
HORIZON = [{"azimuth_deg": 90.0, "elevation_deg": 4.5}, {"azimuth_deg": 270.0, "elevation_deg": 2.0}]
NOTIFIED = {"mail_to": ["night@localhost"], "mail_priorities": [1]}
LEFT_BEHIND = (".sock", "-shm", "-wal", ".lock")


def main() -> int:
    """Make the folder and say how large it is."""
    parser = argparse.ArgumentParser(prog="python -m tests.golden.databases")
    parser.add_argument("version")
    parser.add_argument("--program", type=Path, default=ROOT)
    parser.add_argument("--into", type=Path, default=HERE)
    given = parser.parse_args()
    folder = Folder.of(given.version, given.into.resolve())
    if folder.path.exists():
        parser.error(f"{folder.path} is there already: a folder is never made again.")
    os.environ["PYTHONPATH"] = str(given.program.resolve())
    # The program of 0.1.0 looks for its own parts in the present folder.
    os.chdir(given.program)
    with tempfile.TemporaryDirectory() as name:
        data = Path(name) / "data"
        folder.keep(data, written(data, given.version))
    sys.stdout.write(f"{folder.path}: {folder.size()} bytes\n")
    return 0


def written(data: Path, version: str) -> dict[str, Any]:
    """Have the program write a data folder and return what it told about it after another start."""
    with served(data) as product:
        assert httpx.get(f"{product.url}/health").json()["version"] == version
        show = operated(Integrator(product.url), product.url)
    with served(data) as product, closing(signed_in(product.url)) as browser:
        told = asked(browser, show)
    tidied(data)
    return told


@contextmanager
def served(data: Path) -> Iterator[Product]:
    """Serve the program until it has been used."""
    product = Product.start(data, command=(sys.executable, "-P", "-m", "app.cli"))
    try:
        yield product
    finally:
        product.stop()


def operated(first: Integrator, url: str) -> str:
    """Do everything that is to be kept; return where the planned show is."""
    begin_site(first)
    commission(first)
    second = Integrator(url, "T2")
    second.http = first.http
    second.until_allowed("jog")
    raise_alarm(second)
    run_show(first)
    planned = first.post("/shows", PLANNED)
    sign(first)
    become_private(first)
    return f"{first.tracker}/shows/{planned['show_id']}"


def begin_site(one: Integrator) -> None:
    """Walk steps 1 and 2, and set what belongs to the site."""
    one.call("PATCH", "/api/v1/site", json={"name": "Samsun – upgrade"})
    agreed(one, "PUT", "/api/v1/site/location", SAMSUN)
    agreed(one, "PUT", "/api/v1/site/clock", {"source": "system"})
    one.call("PUT", "/api/v1/site/horizon", json={"points": HORIZON})
    one.call("PUT", "/api/v1/site/notifications", json=NOTIFIED)
    one.call("PUT", "/api/v1/site/weather/windows", json={"gust_s": 5.0})
    one.call("POST", "/api/v1/trackers", json={"tracker_id": "T2", "name": "South field", **SECOND})


def commission(one: Integrator) -> None:
    """Walk steps 3 and 4."""
    one.call("PATCH", "", json=FIRST)
    one.until_allowed("set_home")
    agreed(one, "POST", "/commands", {"type": "set_home"})
    one.until(lambda seen: seen["homed"], "the zero is trusted")
    one.command("set_mode", mode="dual")


def raise_alarm(one: Integrator) -> None:
    """Play a fault, acknowledge the alarm, and end the fault again."""
    one.call("POST", "/fault-injection", json={"fault": "silence"})
    eventually(lambda: standing(one), "there is an alarm")
    one.post(f"/api/v1/alarms/{standing(one)[0]['alarm_id']}/acknowledge")
    one.call("DELETE", "/fault-injection")


def standing(one: Integrator) -> list[dict[str, Any]]:
    """Return the alarms of a tracker that stand now."""
    key = one.tracker.rpartition("/")[2]
    return [alarm for alarm in one.get("/api/v1/alarms")["items"] if alarm["tracker_id"] == key]


def run_show(one: Integrator) -> None:
    """Run a show to its end, so that there is a recording of it."""
    planned = one.post("/shows", RAN)
    assert planned["feasible"], planned["reasons"]
    one.post(f"/shows/{planned['show_id']}/go-to-start")
    one.until(lambda seen: seen["show"] and seen["show"]["phase"] == "ready", "the panel stands at the start")
    one.post(f"/shows/{planned['show_id']}/run")
    one.until(lambda seen: seen["show"] is None, "the show is over", within_s=120.0)


def sign(one: Integrator) -> None:
    """Add a photo and sign the record."""
    picture = io.BytesIO()
    Image.new("RGB", (160, 120), "steelblue").save(picture, "JPEG")
    photo = {"photo": ("cabinet.jpg", picture.getvalue(), "image/jpeg")}
    one.call("POST", "/record/photos", files=photo, data={"caption": "The cabinet"})
    drawn = {"role": "technician", "name": "Ayşe", "strokes": [[[10, 10], [200, 150], [400, 40]]]}
    agreed(one, "POST", "/records", {"signatures": [drawn], "remark": "As left."})


def become_private(one: Integrator) -> None:
    """Add users and a token; from the first user on everybody signs in."""
    one.http.headers["Origin"] = str(one.http.base_url).rstrip("/")
    people = ((NAME, "administrator"), ("olaf", "operator"), ("eva", "engineer"))
    for name, role in people:
        one.post("/api/v1/users", {"name": name, "roles": [role], "password": PASSWORD})
        if name == NAME:
            one.call("POST", "/api/v1/session", json={"name": NAME, "password": PASSWORD})
    one.post("/api/v1/tokens", {"name": "SCADA", "scopes": ["read"], "days": 366, "trackers": ["T1"]})


def agreed(one: Integrator, method: str, path: str, body: dict[str, Any]) -> None:
    """Ask, and say that it is right where that is asked back."""
    try:
        one.call(method, path, json=body)
    except Refused:
        one.call(method, path, json={**body, "confirmed": True})


def tidied(data: Path) -> None:
    """Leave databases complete in themselves, and nothing that only a running program has."""
    for database in data.glob("*.db"):
        with closing(sqlite3.connect(database)) as connection:
            connection.execute("PRAGMA journal_mode = DELETE")
            connection.execute("VACUUM")
    for one in data.iterdir():
        if one.name.endswith(LEFT_BEHIND):
            one.unlink()


if __name__ == "__main__":
    sys.exit(main())
