"""Contacts with triangle soups: a collider of our own for MuJoCo."""
