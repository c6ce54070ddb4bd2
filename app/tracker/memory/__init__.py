"""What a tracker remembers over a restart, and the records it makes."""
