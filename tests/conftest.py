"""What all tests share: the same drawn examples in every run, new ones in the long proofs; none is timed."""

import os

from hypothesis import settings

settings.register_profile("same", derandomize=True, deadline=None)
settings.register_profile("new", deadline=None)
settings.load_profile("new" if "HELIOPANEL_SOAK" in os.environ else "same")
