"""What a tracker tells of itself, in words and numbers."""
