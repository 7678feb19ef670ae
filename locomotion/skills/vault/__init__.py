"""Vaulting over a wall, one hand on its top."""
