"""Photographs a real show of a day into docs/pictures/show.gif, the picture of the README.

`python -m tests.soak.rigs.moving_picture` starts the product on a free port; it needs Chromium.
"""

import tempfile
import time
from io import BytesIO
from pathlib import Path

import httpx
from PIL import Image
from playwright.sync_api import Page, sync_playwright

from tests.e2e.chromium import PROGRAM, QUIET
from tests.e2e.product import Product
from tests.patience import until as eventually

PICTURE = Path(__file__).resolve().parents[2] / "docs" / "pictures" / "show.gif"
SITE = {"latitude_deg": 41.2867, "longitude_deg": 36.33, "altitude_m": 4, "time_zone": "Europe/Istanbul"}
DAY = {"date": "2026-06-21", "duration_s": 120}
SCREEN = {"width": 1024, "height": 768}
SHOWN = (896, 672)
FRAMES = 56
EVERY_S = 2.0
SHOWN_FOR_MS = 120
COLOURS = 48


def commission(api: httpx.Client) -> None:
    """Walk the five steps over the API, for a tracker whose zero is where it stands."""
    api.put("/site/location", json=SITE).raise_for_status()
    api.put("/site/clock", json={"source": "system"}).raise_for_status()
    api.post("/trackers/T1/commands", json={"type": "set_home", "confirmed": True}).raise_for_status()
    eventually(lambda: api.get("/trackers/T1/snapshot").json()["homed"], "the zero is trusted")
    api.post("/trackers/T1/commands", json={"type": "set_mode", "mode": "dual"}).raise_for_status()


def photograph(page: Page) -> list[Image.Image]:
    """Return what the page looks like every two seconds."""
    taken = []
    for _ in range(FRAMES):
        began = time.monotonic()
        shot = Image.open(BytesIO(page.screenshot())).convert("RGB")
        taken.append(shot.resize(SHOWN, Image.Resampling.LANCZOS))
        time.sleep(max(0.0, EVERY_S - (time.monotonic() - began)))
    return taken


def write(frames: list[Image.Image]) -> None:
    """Write one moving picture; all frames share the colours of one from the middle of the day."""
    colours = frames[len(frames) // 2].quantize(COLOURS)
    drawn = [frame.quantize(palette=colours, dither=Image.Dither.NONE) for frame in frames]
    drawn[0].save(
        PICTURE, save_all=True, append_images=drawn[1:], duration=SHOWN_FOR_MS, loop=0, optimize=True
    )


def main() -> None:
    """Start the product, run a show of a day in two minutes, and write the picture."""
    with tempfile.TemporaryDirectory() as folder:
        product = Product.start(Path(folder))
        try:
            with (
                httpx.Client(base_url=f"{product.url}/api/v1", timeout=30) as api,
                sync_playwright() as playwright,
            ):
                commission(api)
                show = api.post("/trackers/T1/shows", json=DAY).json()["show_id"]
                api.post(f"/trackers/T1/shows/{show}/go-to-start").raise_for_status()
                browser = playwright.chromium.launch(executable_path=PROGRAM, args=QUIET)
                page = browser.new_page(viewport=SCREEN, locale="en-GB", timezone_id=SITE["time_zone"])
                page.goto(f"{product.url}/trackers/T1/shows/{show}")
                page.get_by_text("Ready at the start", exact=True).wait_for(timeout=120_000)
                api.post(f"/trackers/T1/shows/{show}/run").raise_for_status()
                page.get_by_text("Running", exact=True).first.wait_for()
                write(photograph(page))
                browser.close()
        finally:
            product.stop()


if __name__ == "__main__":
    main()
