"""The error that every wrong input to this package raises."""


class PathSmoothError(ValueError):
    """Wrong input: the message says what is wrong, where on the path, and what would be right."""
