"""The recipes of docs/develop/contributing.md, each followed in a copy of the program and tried there."""
