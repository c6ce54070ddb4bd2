"""Signed records, photos and labels."""
