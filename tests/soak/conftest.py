"""What judges time judges the product as it is shipped: with real-time scheduling where that is allowed."""

from collections.abc import Iterator

import pytest


@pytest.fixture(scope="package", autouse=True)
def real_time() -> Iterator[None]:
    """Have everything that is started here ask for real-time scheduling."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("HELIOPANEL_REAL_TIME", "on")
        yield
