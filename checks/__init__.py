"""What `make check` asks of texts, documents and generated files; no test runs for these."""
