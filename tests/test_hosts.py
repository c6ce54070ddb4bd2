"""Host names and addresses: what can be one, and that every place where one is typed asks the same check."""

from dataclasses import replace

import pytest
from pydantic import ValidationError

from app.base.hosts import checked_host
from app.base.settings import Settings
from app.link.alarm_orders import SetNotifications
from app.link.messages import CheckConnection, ConfigureTracker
from app.link.weather_orders import SetMetStation
from app.tracker.memory.memory import MetStation
from app.tracker.settings.config import DriveConfig, DriveKind
from app.tracker.values.notifications import Notifications
from tests.site.plant import make_plant

GOOD = (
    "127.0.0.1", "::1", "fe80::1%eth0", "localhost", "plc-1", "plc_1.local", "a.example.", "x" * 63,
    "192.168.0.20", "3com.example",
)  # fmt: skip
BAD = {
    "": "nothing",
    "http://x": "a web address",
    "127.0.0.1;rm": "a command behind it",
    "127.0.0.1\n": "a line feed",
    "plc\x00": "a control character",
    "plc 1": "a space",
    "plc:502": "a port",
    "a..b": "an empty label",
    "-plc": "a hyphen before",
    "plc-": "a hyphen behind",
    "x" * 64: "a label that is too long",
    ".".join(["x" * 60] * 5): "a name that is too long",
    "999.1.1.1": "an address that is none",
    "192.168.0": "three of four numbers",
    "127.0.0.1%eth0": "an interface of IPv4",
    "fe80::1%": "no interface",
    "größe": "letters beyond ASCII",
}


def test_a_host_is_taken_as_it_is() -> None:
    assert [checked_host(host) for host in GOOD] == list(GOOD)


@pytest.mark.parametrize("host", BAD, ids=BAD.values())
def test_what_can_be_no_host_is_refused_with_a_printable_sentence(host: str) -> None:
    with pytest.raises(
        ValueError, match=r"is not a valid host name or address\. Enter the host only"
    ) as told:
        checked_host(host)
    assert str(told.value).isascii()
    assert str(told.value).isprintable()
    assert len(str(told.value)) < 250


async def test_every_order_that_names_a_host_refuses_what_is_none() -> None:
    plant = make_plant()
    await plant.start()
    drive = DriveConfig(DriveKind.MODBUS_TCP, "simulated-plc", host="127.0.0.1;rm")
    orders = [
        SetMetStation(MetStation("127.0.0.1;rm")),
        ConfigureTracker(replace(plant.site.model.tracker("T1").config, drive=drive)),
        CheckConnection("T1", drive),
        SetNotifications(Notifications("https://127.0.0.1;rm/alarms")),
        SetNotifications(Notifications("https://:8443/alarms")),
        SetNotifications(Notifications(mail_to=("name@example..org",))),
    ]
    for order in orders:
        with pytest.raises(ValueError, match="is not a valid host name or address"):
            await plant.ask(order)
    await plant.close()


@pytest.mark.parametrize("field", ["mqtt_host", "smtp_host"])
def test_a_setting_that_is_no_host_ends_the_start(field: str) -> None:
    with pytest.raises(ValidationError, match="is not a valid host name or address"):
        Settings(**{field: "127.0.0.1;rm"})  # type: ignore[arg-type]
