"""The pages of Reference, made of the code: `python -m tools.manual.made` renews them in docs/reference."""
