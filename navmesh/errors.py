"""The error that wrong input to this package raises."""

from surefoot.errors import SurefootError


class NavmeshError(SurefootError):
    """Wrong input: the message says what is wrong, where, and what would be right."""


class NoFloorError(NavmeshError):
    """A level without anything to walk on."""
