"""Bodies that follow a path."""
