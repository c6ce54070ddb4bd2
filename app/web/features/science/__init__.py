"""Accuracy of the algorithms, and the five papers."""
