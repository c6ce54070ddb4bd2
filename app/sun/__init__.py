"""Astronomy: where the sun stands, one module per published algorithm."""
