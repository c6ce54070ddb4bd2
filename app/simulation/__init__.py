"""Simulated drives, their positions, sunlight and faults."""
