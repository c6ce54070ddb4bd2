"""The wire between the panel and the machine."""
