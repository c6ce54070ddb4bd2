"""The integrator's guide is true: its commands are run, one after the other, against the real site."""

import json
import re
import shlex
from pathlib import Path
from typing import Any

import httpx

from tests.web.desk import Desk

GUIDE = Path(__file__).resolve().parents[2] / "docs" / "integrate" / "integrators-guide.md"
ROOT = "http://127.0.0.1:8000"
BLOCK = re.compile(r"^```sh\n(.*?)^```", re.MULTILINE | re.DOTALL)
CAPTURE = re.compile(r"(\w+)=\$\((curl .*) \| jq -r \.(?:items\[0\]\.)?(\w+)\)")


def commands() -> list[str]:
    return [line for block in BLOCK.findall(GUIDE.read_text()) for line in block.splitlines() if line]


def request(line: str, known: dict[str, str]) -> tuple[str, str, dict[str, str], str | None]:
    for name, value in known.items():
        line = line.replace(f"${name}", value)
    words = iter(shlex.split(line)[1:])
    method, url, headers, body = "GET", "", {}, None
    for word in words:
        if word == "-X":
            method = next(words)
        elif word == "-H":
            name, _, value = next(words).partition(": ")
            headers[name] = value
        elif word == "-d":
            body = next(words)
        elif not word.startswith("-"):
            url = word.removeprefix(ROOT)
    return method, url, headers, body


async def curl(desk: Desk, line: str, known: dict[str, str]) -> httpx.Response:
    method, url, headers, body = request(line, known)
    answer = await desk.ask(method, url, headers=headers, content=body)
    assert answer.is_success, f"{line}\n{answer.status_code} {answer.text}"
    return answer


async def follow(desk: Desk) -> dict[str, Any]:
    """Run the guide and return the last answer to every line."""
    known: dict[str, str] = {}
    answers: dict[str, Any] = {}
    for line in commands():
        if line.startswith("sleep "):
            await desk.forward(float(line.split()[1]))
        elif captured := CAPTURE.fullmatch(line):
            name, inner, field = captured.groups()
            found = (await curl(desk, inner, known)).json()
            known[name] = (found["items"][0] if "items" in found else found)[field]
        elif line.startswith("curl "):
            answers[line] = (await curl(desk, line, known)).text
        else:
            name, _, value = line.partition("=")
            known[name] = value
    return answers


async def test_the_guide_walks_from_first_power_to_a_recorded_show(tmp_path: Path) -> None:
    async with Desk(tmp_path) as desk:
        answers = await follow(desk)

    tracking = json.loads(answers["curl -s $API/trackers/T1/snapshot"])
    assert tracking["activity"] == "tracking"
    assert tracking["off_sun_deg"] < 0.5
    frames = json.loads(answers['curl -s "$API/recordings/$RECORDING/samples?points=100"'])
    assert 18 <= frames["sample_count"] <= 100
    sun, panel = frames["columns"]["sun_azimuth_deg"], frames["columns"]["measured_azimuth_deg"]
    assert max(abs(a - b) for a, b in zip(sun, panel, strict=True)) < 2.0
    entries = json.loads(answers['curl -s "$API/journal?limit=20"'])["items"]
    happened = {entry["event"]["kind"] for entry in entries}
    assert {"show_started", "show_ended", "stopped"} <= happened
