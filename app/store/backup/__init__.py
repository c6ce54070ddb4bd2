"""Copies of the database: made, listed, restored."""
