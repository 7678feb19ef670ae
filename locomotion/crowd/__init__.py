"""Crowds: many bodies that walk their routes and keep out of each other's way."""

from locomotion.crowd.crowd import Crowd
from locomotion.crowd.walker import NoRoute, Walker, WalkerState

__all__ = ["Crowd", "NoRoute", "Walker", "WalkerState"]
