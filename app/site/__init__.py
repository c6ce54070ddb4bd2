"""Trackers living on a clock."""
