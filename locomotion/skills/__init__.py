"""Clearing obstacles: the run-up, and the skills that take over at take-off."""
