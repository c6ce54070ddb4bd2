"""Which pages are made of the code."""

from tests.manual.made.alarms import alarms_page
from tests.manual.made.api import api_page
from tests.manual.made.commands import commands_page
from tests.manual.made.errors import errors_page
from tests.manual.made.mqtt import mqtt_page
from tests.manual.made.settings import settings_page
from tests.manual.made.sizing import sizing_page
from tests.manual.made.sunspec import sunspec_page
from tests.manual.site import ROOT

REFERENCE = ROOT / "docs" / "reference"


def pages() -> dict[str, str]:
    """Return each page by the name of its file."""
    return {
        "settings": settings_page(),
        "commands": commands_page(),
        "api": api_page(),
        "errors": errors_page(),
        "alarms": alarms_page(),
        "sunspec-map": sunspec_page(),
        "mqtt-topics": mqtt_page(),
        "sizing": sizing_page(),
    }
