"""Energy studies, strategies and simulated days."""
