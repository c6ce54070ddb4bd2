"""The outside world: simulated and real drives behind one small protocol."""
