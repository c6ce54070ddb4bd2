"""An integrator who knows nothing but the REST API."""

from collections.abc import Callable
from typing import Any

import httpx

from tests.patience import PATIENCE_S
from tests.patience import until as eventually

SAMSUN = {
    "latitude_deg": 41.2867,
    "longitude_deg": 36.33,
    "altitude_m": 4.0,
    "time_zone": "Europe/Istanbul",
}
SOLSTICE_MORNING = "2027-06-21T06:00:00+03:00"


class Refused(Exception):
    """The API answered with a problem."""

    def __init__(self, answer: httpx.Response) -> None:
        super().__init__(f"{answer.status_code}: {answer.text}")
        self.status = answer.status_code
        self.problem: dict[str, Any] = answer.json()

    @property
    def codes(self) -> list[str]:
        """Return the codes of the unmet conditions."""
        return [reason["code"] for reason in self.problem["reasons"]]


class Integrator:
    """Calls to one tracker of one panel."""

    def __init__(self, url: str, tracker_id: str = "T1") -> None:
        self.http = httpx.Client(base_url=url, timeout=PATIENCE_S)
        self.tracker = f"/api/v1/trackers/{tracker_id}"

    def close(self) -> None:
        """Hang up."""
        self.http.close()

    def call(self, method: str, path: str, **more: Any) -> httpx.Response:
        """Return the answer, or raise `Refused`."""
        answer = self.http.request(method, path if path.startswith("/api") else self.tracker + path, **more)
        if answer.is_error:
            raise Refused(answer)
        return answer

    def get(self, path: str, **params: Any) -> Any:
        """Return what a GET answers."""
        return self.call("GET", path, params=params).json()

    def post(self, path: str, body: Any = None) -> Any:
        """Return what a POST answers."""
        return self.call("POST", path, json=body).json()

    def command(self, kind: str, **fields: Any) -> Any:
        """Give a command and return the snapshot after it."""
        return self.post("/commands", {"type": kind, **fields})

    def snapshot(self) -> dict[str, Any]:
        """Return everything about the tracker now."""
        found: dict[str, Any] = self.get("/snapshot")
        return found

    def until(
        self, reached: Callable[[dict[str, Any]], object], what: str, *, within_s: float = PATIENCE_S
    ) -> dict[str, Any]:
        """Return the first snapshot that is so, or fail."""
        last: dict[str, Any] = {}

        def is_so() -> object:
            last.update(self.snapshot())
            return reached(last)

        try:
            eventually(is_so, what, within_s=within_s)
        except TimeoutError as error:
            told = [one["message"] for one in (*last["waiting"], *last["notices"])]
            raise TimeoutError(f"{error} It says: {last['activity_text']}. {told}") from error
        return last

    def until_allowed(self, action: str) -> None:
        """Return once an action is allowed."""
        self.until(lambda seen: not seen["actions"][action], f"{action} is allowed")

    def connect(self, port: int, **change: Any) -> None:
        """Set the drive of the tracker to Modbus TCP at a port, and wait until it answers."""
        drive = {"kind": "modbus-tcp", "profile": "simulated-plc", "host": "127.0.0.1", "port": port}
        self.call("PATCH", "", json={"drive": drive, **change})
        self.until_allowed("jog")

    def place_and_time(self, at: str = SOLSTICE_MORNING, place: dict[str, Any] = SAMSUN) -> None:
        """Walk steps 1 and 2: Samsun, on a summer's morning, if nothing else is said."""
        self.call("PUT", "/api/v1/site/location", json={**place, "confirmed": True})
        self.call("PUT", "/api/v1/site/clock", json={"source": "manual", "at": at, "confirmed": True})

    def zero(self) -> None:
        """Walk step 3 where the panel stands: here is zero."""
        self.until_allowed("set_home")
        self.command("set_home", confirmed=True)
        self.until(lambda seen: seen["homed"], "the zero is trusted")

    def commission(self, port: int, **change: Any) -> None:
        """Walk steps 1 to 4 with a drive at a port."""
        self.connect(port, **change)
        self.place_and_time()
        self.zero()
        self.command("set_mode", mode="dual")

    def journal(self, kind: str) -> list[dict[str, Any]]:
        """Return the newest events of one kind, newest first."""
        entries: list[dict[str, Any]] = self.get("/api/v1/journal", kind=kind, limit=1000)["items"]
        return [entry["event"] for entry in entries]
