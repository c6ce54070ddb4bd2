"""Addresses: of databases and sockets, of topics, of this computer; and how one is shown."""
