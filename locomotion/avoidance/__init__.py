"""How bodies avoid each other and share a goal."""
