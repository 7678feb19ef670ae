"""Rehearsals: trying actions on a copy of the person before it takes them."""
