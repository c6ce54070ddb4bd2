"""What the site writes down: gathered, queued, one transaction a flush."""
