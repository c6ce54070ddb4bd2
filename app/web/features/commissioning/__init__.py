"""Drives, homing, drive tests and the sun check."""
