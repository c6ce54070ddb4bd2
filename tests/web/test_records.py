"""Records are signed, kept, compared and printed; photos come in small and plain."""

import asyncio
import hashlib
import io
import json
from collections.abc import AsyncIterator
from dataclasses import replace
from datetime import timedelta
from pathlib import Path

import pytest
from PIL import Image

from app.link.messages import SetLocation
from app.store.engine import open_reader
from app.sun.position import Location
from app.tracker.commissioning.steps import Step, StepStatus
from app.tracker.memory.memory import StepName
from app.tracker.values.alarm_words import AlarmState
from app.web.features.records.record import MISDATED, read_record
from app.web.features.records.record_page import SignForm
from app.web.features.records.sign_doubts import sign_doubts
from tests.fake_alarms import alarm
from tests.web.desk import Desk
from tests.web.pdf_words import words_of

T1 = "/api/v1/trackers/T1"
UNSIGNED = SignForm().model_dump()
STROKES = [[[10, 20], [400, 250], [900, 30]], [[5, 5], [6, 9]]]
SIGNED = {
    "signatures": [{"role": "technician", "name": "Ayşe Yılmaz", "strokes": STROKES}],
    "confirmed": True,
}


def picture(kind: str = "JPEG", size: tuple[int, int] = (640, 480)) -> bytes:
    """Return a picture whose metadata tell where and with what it was taken."""
    made = Image.new("RGB", size, "teal")
    exif = Image.Exif()
    exif[0x010F] = "SecretMaker"
    exif[0x0112] = 6  # turned by a quarter
    out = io.BytesIO()
    made.save(out, kind, exif=exif, comment=b"SecretComment")
    return out.getvalue()


@pytest.fixture
async def desk(tmp_path: Path) -> AsyncIterator[Desk]:
    async with Desk(tmp_path) as one:
        yield one


async def sign(desk: Desk, **more: object) -> dict[str, object]:
    answer = await desk.ask("POST", f"{T1}/records", json=SIGNED | more)
    assert answer.status_code == 201, answer.text
    found: dict[str, object] = answer.json()
    return found


async def test_a_signed_record_is_its_hash(desk: Desk) -> None:
    head = await sign(desk, remark="Frost on the ground.")
    answer = await desk.ask("GET", f"/api/v1/records/{head['number']}")
    assert hashlib.sha256(answer.content).hexdigest() == head["digest"]
    read = answer.json()
    assert read["signatures"][0]["strokes"] == STROKES
    assert read["remark"] == "Frost on the ground."
    assert read["state"]["tracker"]["tracker_id"] == "T1"
    assert list(read) == sorted(read), "canonical JSON has its keys in order"
    page = (await desk.ask("GET", f"/records/{head['number']}")).text
    assert "M10 20 L400 250 L900 30 M5 5 L6 9" in page
    assert "Ayşe Yılmaz" in page
    pdf = await desk.ask("GET", f"/api/v1/records/{head['number']}?format=pdf")
    assert pdf.content.startswith(b"%PDF-")
    assert "commissioning-T1-1.pdf" in pdf.headers["content-disposition"]


async def test_signing_twice_at_one_instant_keeps_one_record(desk: Desk) -> None:
    """Which of the two comes first, and whether the other one sees it, is left to the computer."""
    asked = [desk.ask("POST", f"{T1}/records", json=SIGNED) for _ in range(2)]
    answers = await asyncio.gather(*asked)
    kept = [one.json() for one in answers if one.status_code == 201]
    refused = [one for one in answers if one.status_code != 201]
    again = await sign(desk)
    assert kept
    assert all(one == again for one in kept)
    assert all(one.status_code == 409 and "already signed" in one.text for one in refused)
    assert len((await desk.ask("GET", "/api/v1/records")).json()["items"]) == 1


async def test_a_later_change_leaves_what_was_signed_and_is_shown_beside_it(desk: Desk) -> None:
    first = await sign(desk)
    assert (await desk.ask("PATCH", T1, json={"deadband_deg": 0.75})).status_code == 200
    second = await sign(desk)
    before = (await desk.ask("GET", "/api/v1/records/1")).content
    assert hashlib.sha256(before).hexdigest() == first["digest"] != second["digest"]
    lines = (await desk.ask("GET", "/api/v1/records/comparison?first=1&second=2")).json()["items"]
    changed = [line for line in lines if line["differs"]]
    assert [line["name"] for line in changed] == ["deadband (°)"]
    assert changed[0]["second"] == "0.75"
    page = (await desk.ask("GET", "/records/compare?pick=1&pick=2")).text
    assert "One line differs" in page
    assert "≠" in page
    assert "≠" not in (await desk.ask("GET", "/records/compare?pick=1&pick=1")).text
    assert [one["number"] for one in (await desk.ask("GET", "/api/v1/records")).json()["items"]] == [2, 1]


async def test_photos_wait_and_go_with_the_next_record(desk: Desk) -> None:
    files = {"photo": ("plate.jpg", picture(size=(4000, 1000)))}
    added = await desk.ask("POST", f"{T1}/record/photos", files=files, data={"caption": "Type plate"})
    assert added.status_code == 201, added.text
    waiting = added.json()["items"][0]
    assert (waiting["width"], waiting["height"]) == (400, 1600)
    content = (await desk.ask("GET", f"/api/v1/record-photos/{waiting['number']}")).content
    assert b"Secret" not in content
    assert hashlib.sha256(content).hexdigest() == waiting["digest"]
    head = await sign(desk)
    assert (await desk.ask("GET", f"{T1}/record/photos")).json()["items"] == []
    record = (await desk.ask("GET", f"/api/v1/records/{head['number']}")).json()
    assert record["photos"] == [
        {"caption": "Type plate", "digest": waiting["digest"], "height": 1600, "width": 400}
    ]
    gone = await desk.ask("DELETE", f"{T1}/record/photos/{waiting['number']}")
    assert gone.status_code == 404
    listed = (await desk.ask("GET", f"/api/v1/records/{head['number']}/photos")).json()["items"]
    assert listed[0]["caption"] == "Type plate"
    pdf = (await desk.ask("GET", f"/api/v1/records/{head['number']}?format=pdf")).content
    assert b"/Subtype /Image" in pdf


@pytest.mark.parametrize(
    ("upload", "words"),
    [
        (picture("PNG")[:300], "not a JPEG or PNG image"),
        (picture("GIF"), "not a JPEG or PNG image"),
        (b"x" * (8 * 1024 * 1024 + 1), "at most 8 MB"),
    ],
)
async def test_what_is_no_photo_is_refused(upload: bytes, words: str, desk: Desk) -> None:
    files = {"photo": ("a.jpg", upload)}
    answer = await desk.ask("POST", f"{T1}/record/photos", files=files)
    assert answer.status_code == 422
    assert words in answer.json()["detail"]
    page = await desk.ask("POST", "/trackers/T1/record/photos", files=files, data={"caption": ""})
    assert (page.status_code, words in page.text) == (422, True)


async def test_a_picture_too_large_to_open_is_refused_before_it_is_opened(desk: Desk) -> None:
    blank = io.BytesIO()
    Image.new("1", (9000, 9000)).save(blank, "PNG")
    answer = await desk.ask("POST", f"{T1}/record/photos", files={"photo": ("a.png", blank.getvalue())})
    assert (answer.status_code, "60 million" in answer.json()["detail"]) == (422, True)


async def test_the_form_signs_and_keeps_what_was_typed_where_it_cannot(desk: Desk) -> None:
    form = UNSIGNED | {"remark": "Sign here", "technician_drawn": json.dumps(STROKES)}
    answer = await desk.ask("POST", "/trackers/T1/record", data=form)
    assert answer.status_code == 422
    assert "type the name of the person who signed" in answer.text
    assert "Sign here" in answer.text
    assert "[400, 250]" in answer.text
    good = await desk.ask(
        "POST", "/trackers/T1/record", data=form | {"technician": "Ion Popescu", "confirmed": "yes"}
    )
    assert good.status_code == 303
    assert good.headers["location"] == "/records/1"
    assert "Ion Popescu" in (await desk.ask("GET", "/records/1")).text


async def test_a_drawing_that_is_none_is_refused(desk: Desk) -> None:
    for drawn in ("[[", "[[[1,2,3],[1,2]]]", "[[[0,0],[1001,0]]]", '{"a": 1}', f"[{'[],' * 300}[]]"):
        form = UNSIGNED | {"technician": "Ion", "technician_drawn": drawn}
        answer = await desk.ask("POST", "/trackers/T1/record", data=form)
        assert (answer.status_code, "sign again" in answer.text) == (422, True), drawn


async def test_a_record_needs_the_technician_and_one_that_is_not_there_is_not_found(desk: Desk) -> None:
    customer = {"signatures": [{"role": "customer", "name": "Owner"}]}
    answer = await desk.ask("POST", f"{T1}/records", json=customer)
    assert (answer.status_code, "technician" in answer.json()["detail"]) == (422, True)
    for path in ("/records/9", "/api/v1/records/9", "/records/compare?pick=1&pick=9"):
        assert (await desk.ask("GET", path)).status_code == 404


async def test_the_label_opens_the_buttons_that_move_the_tracker(desk: Desk) -> None:
    page = (await desk.ask("GET", "/trackers/T1/label?address=https://heliopanel.local:8443/x")).text
    assert "https://heliopanel.local:8443/trackers/T1/mast" in page
    assert "the controller's computer only" in (await desk.ask("GET", "/trackers/T1/label")).text
    wrong = await desk.ask("GET", "/trackers/T1/label?address=javascript:alert(1)")
    assert wrong.status_code == 422
    assert "Address: type how tablets reach" in wrong.text


async def test_open_steps_and_drive_tests_are_asked_about_before_signing(desk: Desk) -> None:
    unasked = {"signatures": SIGNED["signatures"]}
    answer = await desk.ask("POST", f"{T1}/records", json=unasked)
    assert answer.status_code == 422
    for words in ("Step 1, Location, is open.", "Drive tests that are open: ", "with `confirmed`"):
        assert words in answer.json()["detail"]
    form = UNSIGNED | {"technician": "Ion", "remark": "Sign here"}
    shown = await desk.ask("POST", "/trackers/T1/record", data=form)
    assert shown.status_code == 422
    assert "Step 1, Location, is open." in shown.text
    assert 'name="confirmed" value="yes"' in shown.text
    assert "Sign here" in shown.text
    assert (await desk.ask("GET", "/api/v1/records")).json()["items"] == []
    assert (await desk.ask("POST", f"{T1}/records", json=unasked | {"confirmed": True})).status_code == 201


async def test_what_is_alarming_or_dated_in_the_future_is_named(desk: Desk) -> None:
    found = await read_record(desk.plant.site, open_reader(desk.settings.url), "T1")
    at = found.written_at
    step = Step(StepName.CLOCK, StepStatus.DONE, (), at + timedelta(hours=11), "zoe")
    record = replace(found, steps=(step, replace(step, confirmed_at=at)), proofs=())
    mine = alarm("drive_lost", at)
    others = (alarm("drive_lost", at, "T2"), replace(mine, state=AlarmState.RETURNED))
    told = "Step 1, Clock, is dated in the future: the clock was wrong then."
    assert sign_doubts(record, others) == (told,)
    assert sign_doubts(record, (mine, *others)) == (told, f"An alarm is active: {mine.title}.")


async def test_a_step_confirmed_in_the_future_is_marked_on_the_page(desk: Desk) -> None:
    plant = desk.plant
    await plant.ask(SetLocation(Location(41.2867, 36.33, 4.0), "Europe/Istanbul"))
    shown = await desk.ask("GET", "/trackers/T1/record")
    assert 'class="misdated"' not in shown.text
    state = plant.site.model.state
    later = replace(state.confirmations[StepName.LOCATION], at=plant.clock.now() + timedelta(hours=11))
    plant.site.model.state = replace(state, confirmations=state.confirmations | {StepName.LOCATION: later})
    shown = await desk.ask("GET", "/trackers/T1/record")
    assert shown.text.count('class="misdated"') == 1
    printed = await desk.ask("GET", f"{T1}/record", params={"format": "html"})
    assert printed.text.count(MISDATED) == 1
    pdf = await desk.ask("GET", f"{T1}/record", params={"format": "pdf"})
    assert words_of(pdf.content).count(MISDATED) == 1
    head = await sign(desk)
    kept = (await desk.ask("GET", f"/api/v1/records/{head['number']}")).json()
    assert str(kept["sections"]).count(MISDATED) == 1
