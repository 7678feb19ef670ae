"""Leaping across gaps: a jump that is described by a file."""
