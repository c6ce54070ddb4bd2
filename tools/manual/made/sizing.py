"""How much fits: the bounds that the code keeps, and the defaults that decide how much is kept."""

from app.base.settings import PREFIX, Settings
from app.gateway.mqtt_lanes import COMMANDS_PER_S
from app.gateway.mqtt_lanes import MOST_AT_ONCE as COMMANDS_AT_ONCE
from app.gateway.outbox import MOST_UNSENT
from app.gateway.sunspec import LIMITS
from app.site.orders.records import MOST_PHOTOS
from app.site.orders.tracker_setup import MOST_TRACKERS
from app.site.weather.anemometers import MOST_SENSORS
from app.store.chunks import CHUNK_FRAMES
from app.studies.folder import MOST_STUDIES, MOST_WEATHER_FILES
from app.studies.request import MOST_CASES
from app.tracker.memory.recording import COLUMNS
from app.web.http.gate import MOST_STOPS
from app.web.http.limits import MOST_STREAMS, MOST_STREAMS_A_CLIENT
from app.web.http.security import LARGEST_BODY, LARGEST_UPLOAD
from app.web.live.hub import MOST_VIEWERS
from tools.manual.made.markdown import code, page, table

INTRODUCTION = """What one Heliopanel takes and keeps. What it needs for that in time, memory, and disk
is measured: see [benchmarks](../develop/benchmarks.md)."""
MIB = 1024 * 1024
KEPT = (
    "tick_ms", "memory_limit_mb", "sample_store_s", "telemetry_retention_days", "recordings_max",
    "journal_retention_days",
)  # fmt: skip


def sizing_page() -> str:
    """Return the page."""
    bounds = [
        ("trackers of a site", f"{MOST_TRACKERS:,}"),
        ("wind sensors of a site", MOST_SENSORS),
        ("viewers of live values", f"{MOST_VIEWERS:,}"),
        ("open streams: in all, of one address", f"{MOST_STREAMS:,}, {MOST_STREAMS_A_CLIENT}"),
        ("stops a second from one address without a session", MOST_STOPS),
        ("body of a request; of an upload", f"{LARGEST_BODY // MIB} MiB; {LARGEST_UPLOAD // MIB} MiB"),
        ("SunSpec: clients", LIMITS.most),
        ("SunSpec: requests a second of a client, at once", f"{LIMITS.requests_per_s:g}, {LIMITS.burst}"),
        ("MQTT: commands a second of a sender, at once", f"{COMMANDS_PER_S:g}, {COMMANDS_AT_ONCE}"),
        ("MQTT: events that wait for a broker", f"{MOST_UNSENT:,}"),
        ("values of a recorded sample", len(COLUMNS)),
        ("samples of one stored chunk", CHUNK_FRAMES),
        ("photos of a record", MOST_PHOTOS),
        ("studies; weather files; cases of a study", f"{MOST_STUDIES}; {MOST_WEATHER_FILES}; {MOST_CASES}"),
    ]
    kept = [
        (
            code(PREFIX + name.upper()),
            code(Settings.model_fields[name].default),
            Settings.model_fields[name].description,
        )
        for name in KEPT
    ]
    return page(
        "Sizing",
        INTRODUCTION,
        "## Bounds\n\n" + table(("what", "at most"), bounds),
        "## Settings that decide\n\n" + table(("variable", "default", "what"), kept),
    )
