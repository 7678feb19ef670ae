"""How bodies keep out of each other's way, and share a goal."""
