"""Postures and the motions between them, played by elapsed time."""
