"""Every story on every drive."""

import pytest

from tests.drives.conformance import Story, stories_for
from tests.drives.rigs import FULL, RIGS


@pytest.mark.parametrize("name", RIGS)
@pytest.mark.parametrize("tell", stories_for(FULL), ids=lambda tell: tell.__name__)
async def test_story(name: str, tell: Story) -> None:
    async with RIGS[name]() as rig:
        await tell(rig)
