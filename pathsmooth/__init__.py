"""Convex smoothing of paths inside a corridor of discs."""
