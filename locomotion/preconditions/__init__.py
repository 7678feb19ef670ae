"""Preconditions: how likely it is that a skill will hold from the present state."""
