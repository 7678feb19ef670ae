"""Dropping off a ledge and rolling."""
