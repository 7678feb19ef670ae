"""Recorded motion: keyframes and motion capture, and their transfer to our figure."""
