"""Alarms and the journal over API and pages, with the real site behind them."""

from typing import Any

import pytest

from app.alarms.conditions import Condition
from tests.web.desk import Desk
from tests.web.filled import values_of

BEHIND = Condition("store_behind", None, "Site", "The last changes were not stored.")
UNSENT = Condition("notification_failed", None, "Site", "The webhook answered 500.")


@pytest.fixture(autouse=True)
async def troubled(desk: Desk) -> None:
    desk.plant.site.trouble("store", BEHIND)
    desk.plant.site.trouble("webhook", UNSENT)
    await desk.forward(4)


async def standing(desk: Desk) -> dict[str, dict[str, Any]]:
    answer = await desk.ask("GET", "/api/v1/alarms")
    return {one["alarm_id"]: one for one in answer.json()["items"]}


async def test_an_alarm_is_told_acknowledged_and_kept_in_the_history(desk: Desk) -> None:
    found = (await standing(desk))["store_behind"]
    assert (found["priority"], found["state"], found["where"]) == (2, "unacknowledged", "Site")
    answer = await desk.ask("POST", "/api/v1/alarms/store_behind/acknowledge")
    assert answer.status_code == 200
    assert (await standing(desk))["store_behind"]["state"] == "acknowledged"
    desk.plant.site.trouble("store", None)
    await desk.forward(11)
    assert "store_behind" not in await standing(desk)
    history = (await desk.ask("GET", "/api/v1/alarms/history?priority=2")).json()["items"]
    assert [(one["alarm"]["code"], one["ended"]) for one in history] == [("store_behind", True)]
    page = await desk.ask("GET", "/alarms?view=history")
    assert "Nothing can be stored" in page.text


async def test_shelving_needs_a_reason_and_what_was_typed_stays(desk: Desk) -> None:
    form = {"alarm_id": "store_behind", "minutes": "480", "reason": " "}
    answer = await desk.ask("POST", "/alarms/shelve", data=form)
    assert answer.status_code == 422
    assert "Enter the reason for shelving the alarm." in answer.text
    assert '<option value="480" selected>' in answer.text
    done = await desk.ask("POST", "/alarms/shelve", data=form | {"reason": "A bigger card comes."})
    assert done.status_code == 303
    shelved = (await standing(desk))["store_behind"]
    assert (shelved["state"], shelved["shelved_for"]) == ("shelved", "A bigger card comes.")
    assert "A bigger card comes." in (await desk.ask("GET", "/alarms?view=shelved")).text
    await desk.ask("POST", "/api/v1/alarms/store_behind/unshelve")
    await desk.forward(1)
    assert (await standing(desk))["store_behind"]["state"] == "unacknowledged"


async def test_unknown_alarms_are_404_and_long_shelves_422(desk: Desk) -> None:
    answer = await desk.ask("POST", "/api/v1/alarms/drive_lost@T9/acknowledge")
    assert answer.status_code == 404
    long = {"minutes": 1441, "reason": "known"}
    assert (await desk.ask("POST", "/api/v1/alarms/store_behind/shelve", json=long)).status_code == 422


async def test_one_key_acknowledges_what_is_listed(desk: Desk) -> None:
    answer = await desk.ask(
        "POST",
        "/alarms/acknowledge",
        data={"alarm_id": ["store_behind", "notification_failed"], "back": "/alarms?p=2"},
    )
    assert (answer.status_code, answer.headers["location"]) == (303, "/alarms?p=2")
    assert {one["state"] for one in (await standing(desk)).values()} == {"acknowledged"}
    page = (await desk.ask("GET", "/alarms?p=4")).text
    assert 'id="alarm-notification_failed"' in page
    assert 'id="alarm-store_behind"' not in page, "the list is narrowed to a priority"


async def test_the_journal_is_narrowed_and_handed_out_as_a_file(desk: Desk) -> None:
    await desk.ask("POST", "/api/v1/alarms/store_behind/acknowledge")
    found = (await desk.ask("GET", "/api/v1/journal?text=NOTHING%20can&kind=alarm_raised")).json()["items"]
    assert [one["event"]["data"]["code"] for one in found] == ["store_behind"]
    actor = found[0]["event"]["actor"]
    assert actor == "controller"
    others = (await desk.ask("GET", "/api/v1/journal?kind=alarm_raised&actor=nobody")).json()
    assert others["items"] == []
    file = await desk.ask("GET", "/api/v1/journal/export?kind=alarm_acknowledged")
    head, line = file.text.splitlines()
    assert head == "number,at,kind,tracker_id,actor,message,data"
    assert "was acknowledged." in line
    for_excel = await desk.ask("GET", "/api/v1/journal/export?format=excel&kind=alarm_acknowledged")
    assert for_excel.content == b"\xef\xbb\xbf" + file.content
    assert for_excel.headers["content-disposition"] == 'attachment; filename="journal.csv"'
    whole = (await desk.ask("GET", "/api/v1/journal/export?format=json")).json()
    assert {"alarm_raised", "alarm_acknowledged", "controller_started"} & {one["kind"] for one in whole}
    assert (await desk.ask("GET", "/api/v1/journal/export?format=json&actor=nobody")).json() == []


async def test_the_journal_page_keeps_what_was_typed(desk: Desk) -> None:
    page = await desk.ask("GET", "/journal?text=stored&kind=alarm_raised&start=2027-06-21")
    assert page.status_code == 200
    assert 'value="stored"' in page.text
    assert "/api/v1/journal/export?format=excel&amp;kind=alarm_raised&amp;text=stored" in page.text
    wrong = await desk.ask("GET", "/journal?start=tomorrow")
    assert wrong.status_code == 422
    assert 'value="tomorrow"' in wrong.text


async def test_where_alarms_are_sent_is_set_on_a_page_and_over_the_api(desk: Desk) -> None:
    page = "/site/notifications"
    form = values_of((await desk.ask("GET", page)).text, page)
    wrong = await desk.ask("POST", page, data=form | {"mail_to": "ayse", "mail_priority": ["", "1"]})
    assert wrong.status_code == 422
    assert 'value="ayse"' in wrong.text
    form |= {"mail_to": ["ayse@example.org"], "mail_priority": ["", "1", "3"]}
    assert (await desk.ask("POST", page, data=form)).status_code == 303
    kept = (await desk.ask("GET", "/api/v1/site/notifications")).json()
    assert (kept["mail_to"], kept["mail_priorities"]) == (["ayse@example.org"], [1, 3])
    body = {"webhook_url": "gopher://example.org"}
    assert (await desk.ask("PUT", "/api/v1/site/notifications", json=body)).status_code == 422
    assert (await desk.ask("POST", "/api/v1/site/notifications/webhook/test")).status_code == 409
    assert (await desk.ask("POST", "/api/v1/site/notifications/mail/test")).status_code == 202
