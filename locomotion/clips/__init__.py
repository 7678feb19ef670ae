"""Recorded motion: keyframes, motion capture files, and what becomes of them on our figure."""
