"""A world: its level, its agents, and its state."""
