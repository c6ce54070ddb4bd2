"""The guide and the search."""
