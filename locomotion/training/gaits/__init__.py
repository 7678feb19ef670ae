"""Training of walking, running and the changes between them."""
