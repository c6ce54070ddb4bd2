"""Texts that people and other programs write: names, addresses, topics, files."""
