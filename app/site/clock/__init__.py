"""The site's time: what clock it follows, by how much that is off, and when it cannot be right."""
