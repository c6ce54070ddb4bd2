"""A setting of a tracker: what its recipe changes and adds, and the proof that it works."""

FIELD = """    enabled: Enabled = True
    lull_s: Annotated[
        float, Ge(1), Le(600), Setting(N_("Lull duration"), "s", help=N_("Shortest lull that counts."))
    ] = 60.0
"""
EDITS = {"app/tracker/settings/protections.py": (("    enabled: Enabled = True\n", FIELD),)}
NEW: dict[str, str] = {}
PROOF = """

from app.tracker.settings.protections import WindProtection

try:
    WindProtection(lull_s=601.0)
except ValueError as refused:
    assert "Lull duration must be between 1 and 600." in str(refused), refused
else:
    raise AssertionError("the controller takes what is out of its bounds")


async def seen():
    machine = FakeMachine()
    async with serving(fake_app(machine, FakeReader())) as client:
        page = (await client.get("/trackers/T1/protections")).text
        assert 'name="wind_lull_s"' in page, "the form"
        assert "Shortest lull that counts. 1 to 600, usual 60." in page, "its hint"
        found = (await client.get("/search?q=lull+duration")).text
        assert "Lull duration" in found and "/trackers/T1/protections" in found, "the search"
        path = "/api/v1/trackers/T1"
        wrong = await client.patch(path, json={"protection": {"wind": {"lull_s": 601}}})
        assert wrong.status_code == 422 and "between 1 and 600" in wrong.text, wrong.text
        right = await client.patch(path, json={"protection": {"wind": {"lull_s": 90}}})
        assert right.is_success, right.text
        print(*(order.command.kind for order in machine.orders))
"""
