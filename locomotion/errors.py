"""The error that every wrong input to this package raises."""


class LocomotionError(ValueError):
    """Wrong input: the message says what is wrong, where, and what would be right."""
