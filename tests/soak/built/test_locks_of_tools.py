"""The locks of what only releases, documents, and an integrator's client need: whole and installed, too."""

import pytest

from tests.test_locks import HERE, LOCKS
from tests.test_locks import test_a_lock_meets_every_requirement_of_what_it_locks as whole
from tests.test_locks import test_what_is_installed_here_is_what_the_lock_says as installed

OTHERS = [name for name in LOCKS if name not in HERE]


@pytest.mark.parametrize("name", OTHERS)
def test_a_lock_is_whole_and_installed(name: str) -> None:
    whole(name)
    installed(name)
