"""Who and what keeps a tracker from moving: locks, interlocks, inhibit, authority."""
