"""Shows and recordings."""
