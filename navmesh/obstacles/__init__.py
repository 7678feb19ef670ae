"""Obstacles that a skill can clear: kinds, detection along rims, and an author's tags."""
