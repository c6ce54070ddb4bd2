"""What runs in the web process for several features."""
