"""Every story that fits on every shipped profile, against the simulated device of its maker."""

import pytest

from tests.drives.conformance import Story, stories_for
from tests.drives.device_rigs import BENCHES, device_rig

CASES = [(name, tell) for name, bench in BENCHES.items() for tell in stories_for(bench.traits)]


@pytest.mark.parametrize(("name", "tell"), CASES, ids=[f"{name}-{tell.__name__}" for name, tell in CASES])
async def test_story(name: str, tell: Story) -> None:
    async with device_rig(BENCHES[name]) as rig:
        await tell(rig)
