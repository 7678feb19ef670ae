"""The error that wrong input to this package raises."""

from surefoot.errors import SurefootError


class RuntimeInputError(SurefootError):
    """Wrong input: the message says what is wrong, where, and what would be right."""
