"""What stands around each request: server, limits, gate, errors, assets, network."""
