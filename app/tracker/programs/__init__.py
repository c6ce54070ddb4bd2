"""What a tracker can aim at."""
