"""What judges time (timing), builds and installs the product (built), or takes hours (long)."""
