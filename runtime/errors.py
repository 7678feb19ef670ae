"""The error that wrong input to this package raises."""


class RuntimeInputError(ValueError):
    """Wrong input: the message says what is wrong, where, and what would be right."""
