"""The pages of Reference, made of the code: `python -m tests.manual.made` renews them in docs/reference."""
