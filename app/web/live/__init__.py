"""Live values, their viewers, and hold-to-run."""
