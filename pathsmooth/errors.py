"""The error that every wrong input to this package raises."""

from surefoot.errors import SurefootError


class PathSmoothError(SurefootError):
    """Wrong input: the message says what is wrong, where on the path, and what would be right."""
