"""The controller's state in parts, each with one owner, and the snapshot that is told of it."""
