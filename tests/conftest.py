"""What all tests share: drawn examples are the same in every run, and new ones in the long proofs."""

import os

from hypothesis import settings

settings.register_profile("same", derandomize=True)
if "HELIOPANEL_SOAK" not in os.environ:
    settings.load_profile("same")
