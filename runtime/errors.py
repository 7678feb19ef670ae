"""The error raised for wrong input to this package."""

from surefoot.errors import SurefootError


class RuntimeInputError(SurefootError):
    """Wrong input: the message says what is wrong, where, and what would be right."""
