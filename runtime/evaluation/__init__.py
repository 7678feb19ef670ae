"""Trying learned skills from many starts."""
