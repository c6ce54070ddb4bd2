"""Every story on every drive."""

import pytest

from tests.drives.conformance import STORIES, Story
from tests.drives.rigs import RIGS


@pytest.mark.parametrize("name", RIGS)
@pytest.mark.parametrize("tell", STORIES, ids=lambda tell: tell.__name__)
async def test_story(name: str, tell: Story) -> None:
    async with RIGS[name]() as rig:
        await tell(rig)
