"""A technician tests a drive on its page: what it asks and says, on the clock of the controller."""

from playwright.sync_api import Browser, Locator

from tests.browser.site_stage import staged_site


def test_a_drive_is_tested_on_its_page(browser: Browser) -> None:
    """A ramp of 2 degrees a second at 6 a second lasts 0.33 s, the watchdog 0.5 s; read every 20 ms."""
    with staged_site(browser) as stage:
        page = stage.open("/trackers/T1/drive-tests")

        def press(name: str) -> None:
            key = page.get_by_role("button", name=name)
            stage.until(key.is_enabled)
            key.click()

        def state(proof: str, row: int = 0) -> Locator:
            return page.locator(f"#proof-{proof} .proof-states > li").nth(row)

        def done(proof: str, row: int = 0) -> str:
            stage.until(lambda: state(proof, row).get_attribute("data-status") == "done")
            return state(proof, row).inner_text()

        press("Turn elevation by 3°")
        stage.until(page.locator(".ask").count)
        assert "tilt up, toward the sky?" in page.locator(".ask").inner_text()
        press("Yes")
        assert "The panel turned in the direction that the controller reports" in done("direction", 1)
        press("Elevation, jog speed")
        assert "From 2.00 degrees a second, the axis was at standstill 0.34 s and 0.33 degrees after" in done(
            "stop", 2
        )
        press("Test with elevation")
        stage.until(lambda: "Communication-loss test" in (page.locator(".says-text").text_content() or ""))
        assert "slowed down after 0.52 s and stopped after 0.60 s and 0.27 degrees" in done("link-loss")
