"""How long a test waits before it gives up what hangs: one bound for all, which judges nothing.

`HELIOPANEL_TEST_PATIENCE_S` sets it: the gate's computer may be as slow as it likes.
"""

import os

PATIENCE_S = float(os.environ.get("HELIOPANEL_TEST_PATIENCE_S", "60"))
PATIENCE_MS = int(1000 * PATIENCE_S)
TEST_S = 3.0 * PATIENCE_S
"""A test may lose its patience once and still say what it waited for."""
