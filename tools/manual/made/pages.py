"""Which pages are made of the code."""

from tools.manual.made.alarms import alarms_page
from tools.manual.made.api import api_page
from tools.manual.made.commands import commands_page
from tools.manual.made.errors import errors_page
from tools.manual.made.mqtt import mqtt_page
from tools.manual.made.settings import settings_page
from tools.manual.made.sizing import sizing_page
from tools.manual.made.sunspec import sunspec_page
from tools.manual.site import ROOT

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
