"""Who did what: entries that are chained by their hashes, and the check that nobody changed them since."""
