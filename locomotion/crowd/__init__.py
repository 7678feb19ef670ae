"""Crowds: many bodies that walk routes and avoid each other."""

from locomotion.crowd.crowd import Crowd
from locomotion.crowd.walker import NoRoute, Walker, WalkerState

__all__ = ["Crowd", "NoRoute", "Walker", "WalkerState"]
