"""Zones: parts of the floor, such as doorways, that can be blocked and opened again at once."""
