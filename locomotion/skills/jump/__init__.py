"""Jumping onto a stair, and over a gap."""
