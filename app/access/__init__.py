"""Who may do what: roles, users, passwords, sessions, tokens and tickets; nothing here knows the web."""
