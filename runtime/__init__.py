"""Worlds, missions and views."""
