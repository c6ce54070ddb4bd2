"""A simulated day: the same site on a virtual clock, recorded."""
