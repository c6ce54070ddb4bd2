"""What the site is made of while it runs, and what may be said of it."""
